from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    radius, length, collar_radius, collar_height, neck_radius = d["radius"], d["length"], d["collar_radius"], d["collar_height"], d["neck_radius"]
    neck_height, bar = d["neck_height"], d["bar"]
    shape = Cylinder(radius, length, align=HIGH) + Cylinder(collar_radius, collar_height, align=LOW)
    shape += Pos(0, 0, collar_height) * Cylinder(neck_radius, neck_height, align=LOW)
    shape -= Pos(0, 0, collar_height / 2) * Rot(Y=90) * Cylinder(bar / 2, 4 * collar_radius)

    return shape, {
        "thread": {"o": (0, 0, -1), "z": (0, 0, 1), "x": (1, 0, 0)},
        "neck": {"o": (0, 0, collar_height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
