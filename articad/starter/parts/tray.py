"""The tray. A part script defines build(part); it reads no files and imports nothing but its kernel and Python's own modules."""

from build123d import Align, Box, Pos

CORNER = (Align.CENTER, Align.MIN, Align.MIN)  # centred along X, from y = 0 and z = 0 on


def build(part):
    # Every number comes from the plan: change a parameter there, and the part follows.
    d = part.dimensions
    outside = Box(d["width"], d["depth"], d["height"], align=CORNER)
    inside = Pos(0, d["wall"], d["wall"]) * Box(d["width"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"], align=CORNER)

    # One entry for each connector of the plan, where the shape really has it: o a point [mm], z the axis, x which way is zero.
    hinge = {"o": (0, d["depth"], d["height"] + d["gap"]), "z": (-1, 0, 0), "x": (0, -1, 0)}
    return outside - inside, {"hinge": hinge}
