from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Pos(0, 0, -d["play"] - d["board"]) * Cylinder(d["base_r"], d["board"], align=LOW)
    shape += Pos(0, 0, -d["play"] - 1) * Cylinder(d["post_r"], d["post_h"], align=LOW)
    shape += Pos(0, 0, d["post_h"] + d["sun_r"] / 2) * Sphere(d["sun_r"])
    return shape, {
        "o": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
