"""How the lines of every picture look, and how a picture becomes a file."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

# Readable in black and white and by the colour-blind; the third tells itself from the first even
# where it lies on it.
COLOURS = ('#0072b2', '#d55e00', '#000000', '#009e73', '#cc79a7', '#e69f00')
STYLES = ('-', '--', '-.', ':', (0, (5, 1)), (0, (3, 1, 1, 1)))
# As many as these pictures need; few make small files.
PALETTE = 128


def save(figure: Figure, path: Path, dpi: float = 100.0) -> Path:
    """Write a picture as PNG, with its folder, and return where it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn = BytesIO()
    figure.savefig(drawn, format='png', dpi=dpi)
    Image.open(drawn).convert('RGB').quantize(PALETTE).save(path, format='PNG', optimize=True)
    return path
