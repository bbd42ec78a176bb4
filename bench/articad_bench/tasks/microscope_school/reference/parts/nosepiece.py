from build123d import Align, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, -0.3) * Cylinder(d["disc_radius"], 11.7, align=HIGH)
    for i in range(3):
        body += Rot(Z=120 * i) * Pos(13, 0, -10) * Cylinder(6, 22, align=HIGH)
    body -= Cylinder(d["nose_pin"] + d["play"], 100)

    return body, {"nosepiece": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
