from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)
LEFT_LOW = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(d["gate_left"], 0, d["gate_low"]) * Box(d["gate_right"] - d["gate_left"], 30, d["gate_height"], align=LEFT_LOW)
    for z in (167, 767):
        body += Pos(0, 0, z) * (
            Cylinder(14, 30, align=LOW) + Box(d["gate_left"] + 10, 20, 30, align=LEFT_LOW) - Cylinder(d["pin_radius"] + d["clearance"], 100)
        )
    body += Pos(d["latch_x"], 0, d["latch_z"]) * Rot(X=90) * Cylinder(d["latch_pin"], 29, align=LOW)
    for z in (80, 300):
        body += Pos(d["bolt_x"], d["bolt_y"] - 14, z) * Box(30, 30, 20, align=FRONT) - Pos(d["bolt_x"], d["bolt_y"], z) * Cylinder(
            d["bolt_radius"] + d["clearance"], 100
        )

    return body, {
        "hinge": {"o": (0, 0, 167), "z": (0, 0, 1), "x": (1, 0, 0)},
        "latch": {"o": (d["latch_x"], -16, d["latch_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "bolt": {"o": (d["bolt_x"], d["bolt_y"], 20), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
