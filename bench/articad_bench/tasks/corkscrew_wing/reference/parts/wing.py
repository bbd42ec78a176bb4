from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(13, d["wing_thick"])
        + Pos(5, 0, 0) * Box(12, d["wing_thick"], d["reach"], align=HIGH)
        + Pos(5, 0, -d["reach"]) * Rot(X=90) * Cylinder(9, d["wing_thick"])
    )
    body -= Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 50)

    return body, {"wing": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
