from build123d import Cylinder, Pos, Rot, chamfer


def build(part):
    d = part.dimensions
    bar = Cylinder(d.bar, 2 * (d.post_x + d.overhang))
    bar = Pos(Y=-d.standoff) * Rot(Y=90) * chamfer(bar.edges(), 0.3 * d.bar)
    for x in (-d.post_x, d.post_x):
        bar += Pos(x, -d.standoff / 2) * Rot(X=90) * Cylinder(d.post, d.standoff)
    return part.made(bar)
