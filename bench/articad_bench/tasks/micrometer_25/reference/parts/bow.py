from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(-15, 0, -50) * Box(65, d["thickness"], 60, align=LEFT_LOW) - Pos(0, 0, -35) * Box(30, 2 * d["thickness"], 60, align=LEFT_LOW)
    body += Pos(40, 0, 0) * Rot(Y=90) * Cylinder(d["sleeve_radius"], d["sleeve_end"] - 40, align=LOW)
    body -= Pos(20, 0, 0) * Rot(Y=90) * Cylinder(d["spindle_radius"] + d["clearance"], 100, align=LOW) + Pos(-10, 0, 0) * Rot(
        Y=90
    ) * Cylinder(d["anvil_radius"], 20, align=LOW)
    body += Pos(40, 0, -14) * Rot(X=90) * Cylinder(d["lever_pin"], d["thickness"] / 2 + 5, align=LOW)

    return body, {
        "anvil": {"o": (-10, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "spindle": {"o": (d["sleeve_end"], 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "lever": {"o": (40, -d["thickness"] / 2 - 0.3, -14), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
