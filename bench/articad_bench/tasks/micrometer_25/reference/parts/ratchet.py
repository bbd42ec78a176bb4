from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * (Cylinder(d["knob_radius"], 16, align=LOW) - Cylinder(d["spigot"] + 0.2, 13, align=LOW))
    return body, {"ratchet": {"o": (-0.2, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
