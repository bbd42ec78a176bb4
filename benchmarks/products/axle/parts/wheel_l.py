from build123d import Cylinder, Rot


def build(part):
    d = part.dimensions
    return part.made(Rot(Y=90) * (Cylinder(d.radius, d.wide) - Cylinder(d.bore, 2 * d.wide)))
