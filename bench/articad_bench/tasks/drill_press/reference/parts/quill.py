from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["quill"], 150, align=LOW) - Cylinder(d["spindle"] + d["clearance"], 500)
    return body, {"feed": {"o": (0, 0, 50), "z": (0, 0, -1), "x": (1, 0, 0)}, "chuck": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
