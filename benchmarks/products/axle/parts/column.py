from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    body = Cylinder(d.eye, d.thick) + Pos(0, d.arm / 2) * Box(d.eye, d.arm, d.thick)
    body += Pos(0, d.arm) * Cylinder(d.eye, d.thick)
    body += Pos(Z=d.rise / 2) * Cylinder(d.shaft, d.rise)
    return part.made(Pos(Z=d.thick / 2) * body)
