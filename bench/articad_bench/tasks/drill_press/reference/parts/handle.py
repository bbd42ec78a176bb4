from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0.5, 0, 0) * Rot(Y=90) * Cylinder(18, 26, align=LOW)
    for i in range(3):
        body += Rot(X=120 * i) * Pos(14, 0, 0) * (Cylinder(5, d["spoke"], align=LOW) + Pos(0, 0, d["spoke"]) * Sphere(10))
    body -= Rot(Y=90) * Cylinder(d["handle_pin"] + d["clearance"], 100)

    return body, {"handle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
