"""The lid, drawn in its own frame: the plan's rest_pose puts it on the tray."""

from build123d import Align, Box


def build(part):
    d = part.dimensions
    plate = Box(d["width"], d["depth"], d["wall"], align=(Align.CENTER, Align.MAX, Align.MIN))
    return plate, {"hinge": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, -1, 0)}}
