from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    width, depth = d["width"], d["depth"]
    body = Box(width, depth, d["height"], align=UP)
    pd, kd = d["pendulum_bore_depth"], d["key_bore_depth"]
    body = body - Pos(0, -depth / 2 - 1, d["pendulum_z"]) * Rot(X=-90) * Cylinder(
        d["pendulum_bore_radius"], pd + 1, align=UP)
    body = body - Pos(width / 2 - kd, 0, d["key_z"]) * Rot(Y=90) * Cylinder(
        d["key_bore_radius"], kd + 1, align=UP)
    return body, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pendulum_bore": {"o": (0, -depth / 2, d["pendulum_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "key_bore": {"o": (width / 2, 0, d["key_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
