from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, Sphere, extrude, make_hull

TOP = (Align.CENTER, Align.CENTER, Align.MAX)


def bar(d, *ends):
    edges = [edge for x, z in ends for edge in (Pos(x, z) * Circle(d.eye)).edges()]
    return extrude(Plane.XZ * make_hull(edges), d.t / 2, both=True)


def shade(d):
    cup = Pos(Z=-d.drop) * (Cylinder(d.radius, d.high, align=TOP) - Pos(Z=-d.top) * Cylinder(d.radius - d.wall, d.high, align=TOP))
    for side in (-1, 1):
        y = side * (d.t + d.ear_thick) / 2
        cup += Pos(0, y, -(d.drop + 1) / 2) * Box(d.ear, d.ear_thick, d.drop + 1)
        cup += Pos(0, y) * Rot(X=90) * Cylinder(d.ear / 2, d.ear_thick)
    return cup


def build(part):
    d = part.dimensions
    match part.name:
        case "foot":
            shape = Pos(Z=d.thick / 2) * Cylinder(d.radius, d.thick)
        case "turntable":
            shape = Pos(Z=d.disc / 2) * Cylinder(d.radius, d.disc) + Pos(Z=d.high / 2) * Box(d.wide, d.t, d.high)
        case "lower_a":
            shape = Pos(0, d.thick, d.long / 2) * extrude(Plane.XZ * SlotCenterToCenter(d.long, d.wide, rotation=90), d.thick)
        case "upper_a":
            shape = Pos(d.long / 2) * extrude(Plane.XZ * SlotCenterToCenter(d.long, d.wide), d.thick)
        case "elbow":
            shape = bar(d, (0, 0), (d.p, 0), (d.p / 2, d.ez), (d.p / 2, d.ez + d.p))
        case "head":
            shape = bar(d, (0, 0), (0, d.p)) + bar(d, (0, 0), (d.out, -d.down))
        case "shade":
            shape = shade(d)
        case "bulb":
            shape = Pos(Z=-d.neck_long / 2) * Cylinder(d.neck, d.neck_long) + Pos(Z=-d.neck_long - 0.8 * d.ball) * Sphere(d.ball)
        case _:
            shape = Pos(Y=d.thick / 2) * Rot(X=90) * Cylinder(d.radius, d.thick)
    return part.made(shape)
