from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Cylinder(d["seat_radius"], 60, align=LOW) + Cylinder(d["column_radius"], d["column_length"], align=HIGH)
    return body, {"lift": {"o": (0, 0, -150), "z": (0, 0, 1), "x": (1, 0, 0)}}
