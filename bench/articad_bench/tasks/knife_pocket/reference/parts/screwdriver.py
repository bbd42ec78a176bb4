from build123d import Align, Box, Cylinder, Rot


def build(part):
    d = part.dimensions
    body = (
        Rot(X=90) * Cylinder(5.5, d["tool"])
        + Box(d["driver_length"] - 8, d["tool"], 9, align=(Align.MAX, Align.CENTER, Align.CENTER))
        + Box(d["driver_length"], d["tool"], 4, align=(Align.MAX, Align.CENTER, Align.CENTER))
        - Rot(X=90) * Cylinder(d["pin"] + d["clearance"], 20)
    )

    return body, {"screwdriver": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
