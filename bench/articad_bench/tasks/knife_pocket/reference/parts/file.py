from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(5.5, d["tool"])
        + Box(d["file_length"], d["tool"], 8, align=(Align.MAX, Align.CENTER, Align.CENTER))
        - Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 20)
    )
    for i in range(10):
        body -= Pos(-15 - 4 * i, 0, -4) * Box(1.5, 20, 1.5)
    return body, {"file": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
