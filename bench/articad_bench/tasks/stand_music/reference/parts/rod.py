from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Cylinder(d["rod"], d["rod_length"], align=HIGH)
        + Cylinder(d["rod"], 6, align=LOW)
        + Pos(0, 0, 10) * Rot(Y=90) * Cylinder(11, d["eye"])
        - Pos(0, 0, 10) * Rot(Y=90) * Cylinder(d["tilt_pin"] + d["clearance"], 100)
    )
    return body, {"height": {"o": (0, 0, -20), "z": (0, 0, 1), "x": (1, 0, 0)}, "tilt": {"o": (0, 0, 10), "z": (-1, 0, 0), "x": (0, 1, 0)}}
