from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    return part.made(Rot(Y=90) * Cylinder(d.eye, d.thick) + Rot(X=-90) * Cylinder(d.radius, d.long, align=LOW))
