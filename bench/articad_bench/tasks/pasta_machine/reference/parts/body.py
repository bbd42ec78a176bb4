from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(240, 130, 20, align=LOW) + Pos(0, -59, -90) * Box(60, 12, 95, align=LOW) + Pos(0, -65, -90) * Box(60, 60, 20, align=FRONT)
    for side in (-1, 1):
        body += Pos(side * (d["plate_x"] + d["plate"] / 2), 0, 19) * Box(d["plate"], 110, 131, align=LOW)
    body += Pos(-d["plate_x"] - d["plate"] + 1, 30, 60) * Rot(Y=-90) * Cylinder(d["knob_pin"], 15, align=LOW)
    for side in (-1, 1):
        body -= Pos(0, side * (d["roller"] + d["gap"] / 2), d["axle_z"]) * Rot(Y=90) * Cylinder(d["axle"] + d["clearance"], 400)
    body -= Pos(0, -30, -100) * Cylinder(d["screw"] + d["clearance"], 60, align=LOW)

    return body, {
        "front": {"o": (0, -d["roller"] - d["gap"] / 2, d["axle_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "back": {"o": (0, d["roller"] + d["gap"] / 2, d["axle_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "gap": {"o": (-d["plate_x"] - d["plate"], 30, 60), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "clamp": {"o": (0, -30, -80), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
