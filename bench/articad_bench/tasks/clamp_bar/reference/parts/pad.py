from build123d import Align, Cone, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, -8) * Cylinder(d["pad_radius"], 10.5, align=LOW)
        - Sphere(d["ball"] + d["clearance"])
        - Pos(0, 0, 1.2) * Cone(3.5, 12, 5, align=LOW)
    )
    return body, {"pad": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
