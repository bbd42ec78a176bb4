from build123d import Align, Box, Cylinder, Pos, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(5.5, d["tool"])
        + Box(d["opener_length"], d["tool"], 9, align=LEFT)
        - Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 20)
    )
    body -= Pos(d["opener_length"] - 8, 0, 4.5) * Rot(X=90) * Cylinder(4, 20)

    return body, {"opener": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
