from build123d import Align, Cone


def build(part):
    d = part.dimensions
    foot = Cone(d["bottom_radius"], d["top_radius"], d["height"],
                align=(Align.CENTER, Align.CENTER, Align.MIN))
    return foot, {"seat": {"o": (0, 0, d["height"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
