from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.02) * (Cylinder(d["pusher_radius"], 10, align=LOW) + Cylinder(13, 40, align=LOW))
    return body, {"pusher": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
