from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=90) * Cylinder(d.eye, d.thick) + Rot(X=90) * Cylinder(d.radius, d.long, align=LOW)
    body -= Pos(0, -d.start) * Rot(X=90) * Cylinder(d.bore, d.long, align=LOW)
    for side in (-1, 1):
        body -= Pos(side * (d.thick / 2 + d.eye)) * Rot(Y=90) * Cylinder(d.eye, 2 * d.eye)
    return part.made(body)
