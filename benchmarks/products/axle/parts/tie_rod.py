from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    bar = Pos(d.length / 2) * Box(d.length, d.wide, d.thick)
    for x in (0, d.length):
        bar += Pos(x) * Cylinder(d.eye, d.thick)
    return part.made(Pos(Z=d.thick / 2) * bar)
