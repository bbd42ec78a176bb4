from build123d import Align, Cylinder, Pos, Rot, chamfer


def build(part):
    d = part.dimensions
    bar = Cylinder(d["bar_radius"], 2 * (d["post_x"] + d["overhang"]))
    bar = Pos(0, -d["standoff"], 0) * Rot(Y=90) * chamfer(bar.edges(), 0.3 * d["bar_radius"])
    post = Rot(X=90) * Cylinder(d["post_radius"], d["standoff"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    for x in (-d["post_x"], d["post_x"]):
        bar += Pos(x, 0, 0) * post
    return bar, {"mount": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
