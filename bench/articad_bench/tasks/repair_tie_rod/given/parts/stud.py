from build123d import Align, Cylinder, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    ball, stud, length = d["ball"], d["stud"], d["length"]
    shape = Sphere(ball / 2) + Cylinder(stud / 2, length, align=LOW)
    return shape, {"housing": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
