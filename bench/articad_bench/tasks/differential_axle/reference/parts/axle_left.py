from build123d import Align, Cone, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shape = Rot(Y=90) * Pos(0, 0, d["near"]) * Cone(d["tip_r"] - 0.4, d["side_r"] - 0.4, d["far"] - d["near"], align=LOW) + Rot(Y=90) * Pos(0, 0, d["far"] - 1) * Cylinder(d["axle_r"], d["half_track"] - d["far"], align=LOW) + Rot(Y=90) * Pos(0, 0, d["half_track"] - d["wheel_w"]) * Cylinder(d["wheel_r"], d["wheel_w"], align=LOW)
    shape -= Pos(d["half_track"], 0, 0.7 * d["wheel_r"]) * Rot(Y=90) * Cylinder(d["mark"], 10)
    shape = Rot(Z=180) * shape
    return shape, {
        "axle": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
