from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["foot_radius"], 15.5, align=LOW) + Cylinder(d["disc_radius"], 14, align=HIGH)
    return body, {"level_0": {"o": (0, 0, 1), "z": (0, 0, -1), "x": (1, 0, 0)}}
