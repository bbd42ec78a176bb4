from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -d["rod_low"]) * (
        Cylinder(d["spindle"], d["rod_low"] + d["rod_high"], align=LOW) + Cylinder(2.5, 10, align=HIGH) + Pos(0, 0, -10) * Sphere(d["ball"])
    )
    return body, {
        "spindle": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "pad": {"o": (0, 0, -d["rod_low"] - 10), "z": (0, 0, 1), "x": (1, 0, 0)},
        "grip": {"o": (0, 0, d["rod_high"] - 30), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
