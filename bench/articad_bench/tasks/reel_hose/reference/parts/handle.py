from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, d["leg"]) * Rot(Y=90) * Cylinder(9, 2 * d["inner"] - 22)
    for side in (-1, 1):
        body += Pos(side * (d["inner"] - 11), 0, 0) * (
            Cylinder(9, d["leg"], align=LOW) + Pos(0, 0, d["leg"]) * Sphere(9) + Rot(Y=90) * Cylinder(14, 20)
        ) + Pos(side * (d["inner"] - 11), 0, 0) * Rot(Y=90 * side) * Cylinder(d["handle_pin"], d["plate"] + 10, align=LOW)

    return body, {"handle": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
