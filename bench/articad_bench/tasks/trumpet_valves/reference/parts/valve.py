from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["valve"], 90, align=HIGH) + Cylinder(3, 28, align=LOW) + Pos(0, 0, 27) * Cylinder(d["button"], 5, align=LOW)
    return body, {"valve_0": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
