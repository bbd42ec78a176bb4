from build123d import Align, Box, Circle, Plane, Pos, Rectangle, extrude


def build(part):
    d = part.dimensions
    length, thick, face = d["length"], d["thickness"], d["play"] / 2
    outline = Circle(d["big_radius"]) + Pos(0, length) * Circle(d["small_radius"])
    outline += Rectangle(d["shank_width"], length, align=(Align.CENTER, Align.MIN))
    outline -= Circle(d["big_bore"])
    outline -= Pos(0, length) * Circle(d["small_bore"])
    rod = Pos(0, -face, 0) * extrude(Plane.XZ * outline, thick)  # Plane.XZ looks along -Y

    low, high = d["big_radius"] + 4, length - d["small_radius"] - 4
    for y in (-face, -face - thick):
        rod -= Pos(0, y, (low + high) / 2) * Box(d["groove_width"], thick / 3, high - low)
    return rod, {
        "big_end": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
        "small_end": {"o": (0, -face - thick / 2, length), "z": (0, -1, 0), "x": (0, 0, 1)},
    }
