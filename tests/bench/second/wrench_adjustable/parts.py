from build123d import Align, Box, Cylinder, PolarLocations, Pos, Rot, Torus

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def wrench(thick, long, handle, head_x, head_low, head_top, jaw_x, jaw_z, rod_x, rod_d, play, worm_x, worm_d, worm, journal_d, side, eye_x, eye_d):
    """Handle, head and fixed jaw; a window for the worm, which is open to the rod's bore."""
    y = (-thick / 2, thick / 2)
    body = block((0, head_x + 1), y, (-handle / 2, handle / 2)) + block((head_x, jaw_x - side), y, (head_low, head_top))
    body += block((head_x, long), y, (jaw_z, head_top))
    body -= Pos(eye_x, 0, 0) * Rot(X=90) * Cylinder(eye_d / 2, 2 * thick)
    body -= Pos(rod_x, 0, 2 * head_low) * Cylinder(rod_d / 2 + play, 4 * head_top, align=UP)
    high = worm / 2 + side
    body -= block((worm_x - worm_d / 2 - 1, worm_x + worm_d / 2 + 1), (-thick, thick), (-high, high))
    return body - Pos(worm_x, 0, 0) * Cylinder(journal_d / 2 + play, worm + 10)


def jaw(thick, long, rod_x, jaw_x, jaw_z, head_top, head_low, total, shut, rod_d, foot=12):
    """About the rod's axis, from the lower edge; the rod reaches through the head."""
    y, lift = (-thick / 2, thick / 2), total - head_top
    body = block((jaw_x - rod_x, long - rod_x), y, (0, jaw_z - shut + lift)) + block((-rod_d / 2 - 1, jaw_x - rod_x + 1), y, (0, foot))
    return body + Cylinder(rod_d / 2, lift + head_top, align=UP)


def worm(worm_d, worm, journal_d):
    body = Cylinder(worm_d / 2, worm) + Cylinder(journal_d / 2, worm + 9)
    for place in PolarLocations(worm_d / 2, 16):
        body -= place * Cylinder(0.5, 2 * worm)
    return body


def ring(ring_d, wire):
    """About the middle of the wire in the eye; the ring lies flat towards -x."""
    radius = (ring_d - wire) / 2
    return Pos(-radius, 0, 0) * Torus(radius, wire / 2)
