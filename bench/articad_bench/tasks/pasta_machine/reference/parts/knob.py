from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(-0.4, 0, 0) * Rot(Y=-90) * (
        Cylinder(d["knob_radius"], 16, align=LOW) + Pos(0, d["knob_radius"], 0) * Box(6, 12, 6, align=LOW)
    ) - Rot(Y=90) * Cylinder(d["knob_pin"] + d["clearance"], 100)
    return body, {"gap": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
