from build123d import Align, Cylinder, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, radius, bore, chamber, neck_radius = d["length"], d["radius"], d["bore"], d["chamber"], d["neck_radius"]
    neck_top, stem_bore = d["neck_top"], d["stem_bore"]
    shape = Rot(Y=90) * Cylinder(radius, length) + Cylinder(neck_radius, neck_top, align=LOW)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 2 * length) + Sphere(chamber)
    shape -= Cylinder(stem_bore / 2, 2 * neck_top, align=LOW)

    return shape, {"stem": {"o": (0, 0, neck_top), "z": (0, 0, 1), "x": (1, 0, 0)}}
