from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Cylinder(d["pole"], d["pole_height"], align=LOW) + Pos(0, 0, d["pole_height"] - 1) * Cylinder(d["pin"], 41, align=LOW)
    return body, {"follow": {"o": (0, 0, d["pole_height"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
