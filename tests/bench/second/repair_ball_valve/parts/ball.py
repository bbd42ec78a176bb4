from build123d import Align, Cylinder, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, bore, stem_radius, stem_top, neck_top = d["radius"], d["bore"], d["stem_radius"], d["stem_top"], d["neck_top"]
    shape = Sphere(radius) + Cylinder(stem_radius, stem_top, align=LOW) - Rot(Y=90) * Cylinder(bore / 2, 3 * radius)

    return shape, {
        "stem": {"o": (0, 0, neck_top), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lever": {"o": (0, 0, stem_top), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
