"""Raised letters on a plate

Shows: Text, extrude
Dimensions: {"width": 70, "depth": 24, "thickness": 3, "relief": 1, "letters": 12}
"""

from build123d import Align, Box, Plane, Text, extrude


def build(part):
    d = part.dimensions
    plate = Box(d["width"], d["depth"], d["thickness"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    letters = extrude(Plane.XY.offset(d["thickness"]) * Text("ARTICAD", font_size=d["letters"]), amount=d["relief"])
    return plate + letters, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
