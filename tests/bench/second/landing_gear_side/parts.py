"""Links lie along x, their rear faces at y = -gap; pins along y."""

from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, chamfer, extrude, make_hull

TO_FRONT = Rot(90, 0, 0)  # z to -y


def plate(flat, gap, thick):
    """Extrude an outline of x and z to the front of the gap."""
    return Pos(0, -gap, 0) * TO_FRONT * extrude(flat, thick)


def pin_at(x, z, radius, near, far):
    """A pin along y from near to far."""
    return Pos(x, (near + far) / 2, z) * TO_FRONT * Cylinder(radius, abs(far - near))


def bar(long, eye):
    return Pos(long / 2, 0) * Rectangle(long, 2 * eye) + Circle(eye) + Pos(long, 0) * Circle(eye)


def spar(left, spar_long, spar_top, spar_high, spar_thick, cx, cz, sx, sz, p, pin):
    body = Pos(left, 0, spar_top) * Box(spar_long, spar_thick, spar_high, align=(Align.MIN, Align.MIN, Align.MAX))
    for x, z, layers in ((0, 0, 2), (sx, sz, 3), (cx, cz, 1)):
        body += pin_at(x, z, pin / 2, 1, -layers * p)
    return body


def leg(leg, eye, thick, gap, pin, play, lug, lug_deg, knee_at, p):
    ear = Pos(lug * cos(radians(lug_deg)), lug * sin(radians(lug_deg)))
    outline = make_hull((Circle(eye) + ear * Circle(eye) + Pos(leg, 0) * Circle(eye)).edges()) - Circle(pin / 2 + play)
    body = plate(outline, gap, thick)
    body += pin_at(ear.position.X, ear.position.Y, pin / 2, -gap - 1, p - gap)
    body += pin_at(leg, 0, pin / 2, -gap - 1, p - gap)
    return body + pin_at(knee_at, 0, pin / 2, -p + 1, -3 * p)


def barrel(eye, thick, gap, pin, play, barrel_d, barrel_long, rod_d):
    body = plate(Circle(eye), gap, thick)
    body += Pos(0, -gap - thick / 2, 0) * Rot(0, 90, 0) * Cylinder(barrel_d / 2, barrel_long, align=(Align.CENTER, Align.CENTER, Align.MIN))
    body -= Pos(eye + 4, -gap - thick / 2, 0) * Rot(0, 90, 0) * Cylinder(rod_d / 2 + play, barrel_long, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body - pin_at(0, 0, pin / 2 + play, 9, -99)


def rod(eye, thick, gap, pin, play, rod_d, rod_long):
    body = plate(Circle(eye), gap, thick)
    body += Pos(0, -gap - thick / 2, 0) * Rot(0, 90, 0) * Cylinder(rod_d / 2, rod_long, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body - pin_at(0, 0, pin / 2 + play, 9, -99)


def stay_upper(upper, eye, thick, gap, pin, play, p):
    return plate(bar(upper, eye) - Circle(pin / 2 + play), gap, thick) + pin_at(upper, 0, pin / 2, -p + 1, -2 * p)


def stay_lower(lower, eye, thick, gap, pin, play):
    return plate(bar(lower, eye) - Circle(pin / 2 + play) - Pos(lower, 0) * Circle(pin / 2 + play), gap, thick)


def wheel(wheel, thick, gap, pin, play):
    body = plate(Circle(wheel / 2) - Circle(pin / 2 + play), gap, thick)
    return chamfer([e for e in body.edges() if e.length > 3 * wheel], 1.5)
