from build123d import Align, Cone, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(-230, 0, d["mouth_z"]) * Rot(Y=90) * Cylinder(d["tube"], 230, align=LOW)
        + Pos(0, 0, -34) * Rot(Y=90) * Cylinder(d["tube"], 190, align=LOW)
        + Pos(180, 0, -34)
        * Rot(Y=90)
        * (Cone(d["tube"], d["bell_radius"], 80, align=LOW) - Pos(0, 0, 4) * Cone(d["tube"] - 2, d["bell_radius"] - 1, 80, align=LOW))
    )
    for z in (d["mouth_z"], 50):
        body += Pos(0, 0, z) * Rot(Y=90) * Cylinder(d["tube"], 120, align=LOW)
    for z in (-10, 16):
        body += Pos(24, -20, z) * Rot(Y=-90) * Cylinder(d["tube"], 84, align=LOW) + Pos(24, 0, z) * Rot(X=90) * Cylinder(
            d["tube"], 26, align=LOW
        )
    for i in (-1, 0, 1):
        body += Pos(i * d["pitch"], 0, 0) * Cylinder(12.5, 120)
    for i in (-1, 0, 1):
        body -= Pos(i * d["pitch"], 0, -50) * Cylinder(d["valve"] + d["clearance"], 200, align=LOW)
    for z in (d["mouth_z"], 50):
        body -= Pos(38, 0, z) * Rot(Y=90) * Cylinder(d["bore"] + d["clearance"], 200, align=LOW)
    for z in (-10, 16):
        body -= Pos(18, -20, z) * Rot(Y=-90) * Cylinder(d["bore"] + d["clearance"], 200, align=LOW)
    body -= Pos(-220, 0, d["mouth_z"]) * Rot(Y=-90) * Cylinder(d["bore"] + d["clearance"], 100, align=LOW)

    return body, {
        "valve_0": {"o": (-1 * d["pitch"], 0, 60), "z": (0, 0, -1), "x": (1, 0, 0)},
        "valve_1": {"o": (0 * d["pitch"], 0, 60), "z": (0, 0, -1), "x": (1, 0, 0)},
        "valve_2": {"o": (1 * d["pitch"], 0, 60), "z": (0, 0, -1), "x": (1, 0, 0)},
        "main_slide": {"o": (120, 0, d["mouth_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "third_slide": {"o": (-60, -20, -10), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "mouthpiece": {"o": (-230, 0, d["mouth_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
