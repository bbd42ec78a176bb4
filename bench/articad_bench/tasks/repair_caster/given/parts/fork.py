from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    top, length, rivet_hole, cheek, inside = d["top"], d["length"], d["rivet_hole"], d["cheek"], d["inside"]
    trail, drop, axle, eye = d["trail"], d["drop"], d["axle"], d["eye"]
    wide = inside + 2 * cheek
    shape = Pos(-trail / 2 + 2, 0, -0.3) * Box(length, wide, top, align=HIGH)
    cheeks = Pos(-trail, 0, -0.3) * Box(eye, wide, drop - 0.3, align=HIGH) + Pos(-trail, 0, -drop) * Rot(X=90) * Cylinder(eye / 2, wide)
    cheeks -= Pos(-trail, 0, -0.3 - top) * Box(4 * eye, inside, 4 * drop, align=HIGH)
    shape += cheeks
    shape -= Cylinder(rivet_hole / 2, 4 * top) + Pos(-trail, 0, -drop) * Rot(X=90) * Cylinder(axle / 2, 2 * wide)
    return shape, {
        "plate": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "wheel": {"o": (-trail, 0, -drop), "z": (0, 1, 0), "x": (1, 0, 0)},
        "axle": {"o": (-trail, -inside/2 - cheek, -drop), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
