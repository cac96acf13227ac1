"""Every test of the repository looks for examples as the package's own tests do."""

import runpy
from pathlib import Path

runpy.run_path(str(Path(__file__).resolve().parent / 'src/wrist_control/test/conftest.py'))
