from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0.5, 0, 0) * Rot(Y=90) * (Cylinder(d["knob_radius"], 14, align=LOW) + Cylinder(d["knob_shaft"], 1, align=LOW))
        + Pos(1, 0, 0) * Rot(Y=-90) * Cylinder(d["knob_shaft"], 16, align=LOW)
        + Pos(14, 0, 4) * Box(3, 3, 12)
    )
    return body, {"browning": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
