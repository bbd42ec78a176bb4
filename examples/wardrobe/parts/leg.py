from build123d import Align, Cone, Cylinder


def build(part):
    d = part.dimensions
    leg = Cone(d["bottom_radius"], d["top_radius"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    leg += Cylinder(d["spigot_radius"], d["spigot_length"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    return leg, {"top": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
