from build123d import Align, Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    panel = Pos(-d.inset, -d.inset) * Box(d.width, d.thick, d.height, align=(Align.MIN,) * 3)
    return part.made(panel - Pos(Z=d.height) * Cylinder(d.hinge_bore / 2, 2 * d.upper))
