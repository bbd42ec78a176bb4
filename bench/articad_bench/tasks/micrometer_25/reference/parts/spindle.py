from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(62, 0, 0) * Rot(Y=90) * (Cylinder(d["thimble_radius"], 48, align=LOW) - Cylinder(d["sleeve_radius"] + 0.4, 40, align=LOW))
    body += Rot(Y=90) * Cylinder(d["spindle_radius"], 105, align=LOW) + Pos(109, 0, 0) * Rot(Y=90) * Cylinder(d["spigot"], 13, align=LOW)

    return body, {
        "spindle": {"o": (95 - 2.1, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "ratchet": {"o": (110, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
