"""Hollow out a box to thin walls, open at the top

Shows: offset, ShapeList.sort_by, Box
Dimensions: {"width": 60, "depth": 40, "height": 30, "wall": 2}
"""

from build123d import Align, Axis, Box, offset


def build(part):
    d = part.dimensions
    block = Box(d["width"], d["depth"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape = offset(block, amount=-d["wall"], openings=block.faces().sort_by(Axis.Z)[-1])
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
