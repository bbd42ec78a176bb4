"""Inner arms lie within half, outer arms, lugs and rails beyond it; the pins of inner arms and carriages reach outwards."""

from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def across(x, z, half, radius):
    return Pos(x, 0, z) * Rot(X=90) * Cylinder(radius, 2 * half)


def bar(x, arm, wide, holes, hole_d, start, strip):
    """A flat bar along x at both sides."""
    outline = Pos(x, 0) * SlotCenterToCenter(arm, wide)
    for at in holes:
        outline -= Pos(at, 0) * Circle(hole_d / 2)
    flat = extrude(outline, strip)
    return (Plane((0, start + strip, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0)) * flat) + (
        Plane((0, -start, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0)) * flat
    )


def inner(arm, half, strip, air, pin_d, wide):
    body = bar(arm / 2, arm, wide, (), pin_d, half - strip, strip)
    for x in (0, arm / 2, arm):
        for side in (-1, 1):
            body += Pos(x, side * (half + air + strip / 2 - 1), 0) * Rot(X=90) * Cylinder(pin_d / 2, strip + 2)
    return body + across(arm / 2, 0, half - 1, pin_d / 2 + 1)


def outer(arm, half, strip, air, pin_d, play, wide, tie_d=8):
    body = bar(-arm / 2, arm, wide, (0, -arm / 2, -arm), pin_d + 2 * play, half + air, strip)
    return body + across(-arm / 4, 0, half + air + 1, tie_d / 2)


def channel(reach, stroke, up, down):
    """Two edges with lips that hold a runner, from z = up to z = down; the lips are at down."""
    long, low, high = stroke + 44, min(up, down), max(up, down)
    at = Pos(reach - stroke / 2, 0, 0)
    lip = high - 4.5 if down > up else low
    body = at * Pos(0, 0, low) * Box(long, 68, high - low, align=UP) - at * Pos(0, 0, low - 1) * Box(2 * long, 52, high - low + 2, align=UP)
    return body + at * Pos(0, 0, lip) * Box(long, 68, 4.5, align=UP) - at * Pos(0, 0, low - 1) * Box(2 * long, 40, high - low + 2, align=UP)


def base(half, strip, air, pin_d, play, foot_z, reach, stroke, plate=8):
    """A plate with a lug at either side for the inner arm's pins, and a channel for the carriage."""
    body = Pos(reach / 2, 0, 0) * Box(reach + 60, 2 * half + 40, plate, align=UP)
    for side in (-1, 1):
        y = side * (half + air + strip / 2)
        body += Pos(0, y, 0) * Box(18, strip, foot_z + 9, align=UP)
    body += channel(reach, stroke, plate - 1, plate + 10)
    return body - across(0, foot_z, 2 * half, pin_d / 2 + play)


def runner(sole):
    """What slides in a channel, down to z = -sole."""
    return Pos(0, 0, -sole) * Box(36, 51.7, 5, align=UP) + Pos(0, 0, -sole) * Box(36, 39, sole, align=UP)


def carriage_low(half, strip, air, pin_d, foot_z, plate=8):
    """A cross bar between the outer arm's bars, with pins outwards."""
    body = Box(20, 2 * (half - air), 14) + runner(foot_z - plate - 0.2)
    for side in (-1, 1):
        body += Pos(0, side * (half + strip / 2), 0) * Rot(X=90) * Cylinder(pin_d / 2, strip + 2 * air + 4)
    return body


def carriage_high(half, strip, air, pin_d, play, foot_z, plate=8):
    """A bridge over the inner arm's bars, with bores for their pins."""
    body = Pos(0, 0, 9.5) * Box(36, 2 * (half + air + strip), 2.5, align=UP) + Pos(0, 0, 9.5) * Rot(X=180) * runner(
        foot_z - plate - 0.2 - 9.5
    )
    for side in (-1, 1):
        body += Pos(0, side * (half + air + strip / 2), -9) * Box(18, strip, 19, align=UP)
    return body - across(0, 0, 2 * half, pin_d / 2 + play)


def platform(half, strip, air, pin_d, foot_z, reach, stroke, plate=8):
    """A plate above the arms, with lugs that carry pins for the last outer arm, and a channel below it."""
    body = Pos(reach / 2, 0, foot_z - plate) * Box(reach + 60, 2 * half + 40, plate, align=UP)
    body += channel(reach, stroke, foot_z - plate + 1, foot_z - plate - 10)
    for side in (-1, 1):
        body += Pos(0, side * (half - strip / 2), -9) * Box(18, strip, foot_z - plate + 10, align=UP)
        body += Pos(0, side * (half + air + strip / 2), 0) * Rot(X=90) * Cylinder(pin_d / 2, strip + 2 * air + 3)
    return body
