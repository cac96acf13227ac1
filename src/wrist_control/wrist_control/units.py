"""The papers' unit of length, in SI units."""

INCH = 0.0254  # m
