from build123d import Cylinder, Pos, Sphere


def build(part):
    d = part.dimensions
    return part.made(Pos(Z=-d.neck_long / 2) * Cylinder(d.neck, d.neck_long) + Pos(Z=-d.neck_long - 0.8 * d.ball) * Sphere(d.ball))
