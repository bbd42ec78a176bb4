from build123d import Align, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Sphere(d["ball"]) + Cylinder(d["neck"], 30, align=LOW) + Pos(0, 0, 38) * Sphere(d["head_radius"])
    return body, {"neck": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
