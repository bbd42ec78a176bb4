from build123d import Align, Axis, Cylinder, chamfer


def build(part):
    d = part.dimensions
    foot = Cylinder(d["radius"], d["height"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    foot = chamfer(foot.edges().sort_by(Axis.Z)[0], d["edge"])
    return foot, {"top": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
