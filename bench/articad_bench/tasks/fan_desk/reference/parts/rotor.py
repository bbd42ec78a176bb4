from build123d import Align, Box, Cylinder, Rot

LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Rot(X=90) * Cylinder(18, 18)
    for i in range(4):
        body += Rot(Y=90 * i) * Rot(X=25) * Box(d["rotor_radius"], 4, 44, align=LEFT)
    body -= Rot(X=90) * Cylinder(d["shaft"] + d["clearance"], 100)

    return body, {"spin": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
