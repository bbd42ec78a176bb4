from build123d import Align, Box, Cylinder, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(3.5, 11) + Box(d["lever_length"], 11, 7, align=LEFT)
    body -= Rot(X=90) * Cylinder(d["pin_radius"] + d["clearance"], 20)

    return body, {"flow": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
