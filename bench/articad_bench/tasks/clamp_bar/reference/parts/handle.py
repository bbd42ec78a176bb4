from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["handle_radius"], 90, align=LOW) - Cylinder(d["spindle"], 30, align=LOW)
    return body, {"grip": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
