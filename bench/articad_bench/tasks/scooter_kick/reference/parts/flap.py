from build123d import Align, Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(8, 30)
        + Box(d["flap_length"], 30, 4, align=(Align.MAX, Align.CENTER, Align.CENTER))
        - Rot(X=90) * Cylinder(d["flap_pin"] + d["clearance"], 60)
    )
    return body, {"flap": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
