from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(-d["length"], 0, d["ws"]) * Rot(Y=90) * Cylinder(d["screw_r"], d["length"] - d["half_block"], align=LOW) + Pos(-d["half_block"] - 1, 0, d["ws"]) * Rot(Y=90) * Cylinder(d["neck_r"], 2 * d["half_block"] + 2, align=LOW)
    shape += Pos(d["half_block"], 0, d["ws"]) * Rot(Y=90) * Cylinder(d["eye_r"], 2 * d["collar"], align=LOW) + Pos(d["half_block"] + d["collar"], 0, d["ws"]) * Box(d["collar"], 40, 6)
    return FRONT * shape, {
        "trunnion": {"o": (0, -d["ws"], 0), "z": (1, 0, 0), "x": (0, -1, 0)},
        "nut": {"o": (0, -d["ws"], 0), "z": (1, 0, 0), "x": (0, -1, 0)},
    }
