"""How a picture becomes a file."""

from io import BytesIO

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from wrist_control.studies.pictures import COLOURS, STYLES, save


def drawn():
    figure = Figure(figsize=(3.0, 2.0), layout='constrained')
    axes = figure.subplots()
    for column, (colour, style) in enumerate(zip(COLOURS, STYLES, strict=True)):
        axes.plot([0.0, 1.0], [column, column], color=colour, linestyle=style, label=str(column))
    axes.legend()
    return figure


def test_a_picture_is_saved_as_it_was_drawn_into_a_folder_that_need_not_be_there(tmp_path):
    path = save(drawn(), tmp_path / 'a' / 'b.png', dpi=80.0)
    assert path == tmp_path / 'a' / 'b.png'
    assert path.read_bytes().startswith(b'\x89PNG')
    exact = BytesIO()
    drawn().savefig(exact, format='png', dpi=80.0)
    pixels = [np.asarray(Image.open(one).convert('RGB'), float) for one in (path, exact)]
    assert pixels[0].shape == (160, 240, 3)
    assert np.abs(pixels[0] - pixels[1]).mean() < 0.5
    assert np.abs(pixels[0] - pixels[1]).max() < 40.0


def test_the_same_picture_is_the_same_file(tmp_path):
    first, second = (save(drawn(), tmp_path / name) for name in ('1.png', '2.png'))
    assert first.read_bytes() == second.read_bytes()
