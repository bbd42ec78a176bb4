from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * Cylinder(18, 16, align=LOW)
    for i in range(6):
        body += Rot(X=60 * i) * (Pos(8, 0, 10) * Rot(Z=30) * Box(3, 26, d["rotor_radius"] - 12, align=LOW))
    body -= Rot(Y=90) * Cylinder(d["shaft"] + d["clearance"], 200)

    return body, {"spin": {"o": (-7, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
