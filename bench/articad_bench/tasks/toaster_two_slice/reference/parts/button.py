from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(5, 0, 0) * Rot(Y=90) * Cylinder(d["button_radius"], 8, align=LOW) + Pos(6, 0, 0) * Rot(Y=-90) * Cylinder(
        d["knob_shaft"], 20, align=LOW
    )
    return body, {"stop": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)}}
