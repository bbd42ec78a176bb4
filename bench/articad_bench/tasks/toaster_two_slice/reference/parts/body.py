from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Box(d["length"], d["depth"], d["height"], align=LOW) - Pos(0, 0, d["wall"]) * Box(
        d["length"] - 2 * d["wall"], d["depth"] - 2 * d["wall"], d["height"] - 2 * d["wall"], align=LOW
    )
    for y in (-30, 30):
        body -= Pos(0, y, d["height"]) * Box(140, 30, 40)
    body -= Pos(d["length"] / 2, 0, 50) * Box(40, 2 * d["stem"] + 1, 100, align=LOW)
    for z in (60, 110):
        body -= Pos(d["length"] / 2, 45, z) * Rot(Y=90) * Cylinder(d["knob_shaft"] + d["clearance"], 40)
    body -= Pos(-d["length"] / 2, 0, d["wall"]) * Box(40, d["depth"] - 40, d["tray_height"] + 0.6, align=LOW)

    return body, {
        "lever": {"o": (0, 0, 140), "z": (0, 0, -1), "x": (1, 0, 0)},
        "tray": {"o": (d["length"] / 2 - d["wall"] - 4, 0, d["wall"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "browning": {"o": (d["length"] / 2, 45, 60), "z": (1, 0, 0), "x": (0, 1, 0)},
        "stop": {"o": (d["length"] / 2, 45, 110), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
