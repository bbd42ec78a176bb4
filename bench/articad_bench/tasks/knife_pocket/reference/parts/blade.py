from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(5.5, d["tool"])
        + Box(d["blade_length"], d["tool"], 9, align=LEFT)
        - Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 20)
    )
    body -= Pos(d["blade_length"], 0, -4.5) * Rot(Y=-60) * Box(60, 20, 9, align=LEFT_LOW)

    return body, {"blade": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
