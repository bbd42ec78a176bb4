from build123d import Align, Axis, Box, Cone, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
ALONG_X, ALONG_Y = Rot(0, 90, 0), Rot(-90, 0, 0)


def bevel(near, far, gap, hub, hub_end):
    """A gear of 45 degrees along z, its apex at the origin."""
    return Pos(0, 0, near) * Cone(near - gap, far - gap, far - near, align=UP) + Pos(0, 0, near) * Cylinder(hub / 2, hub_end - near, align=UP)


def wheel(near, far, gap, hub, hub_end, axle, faces, wheel, wheel_wide):
    """Side gear, half axle and wheel in one piece along +x."""
    body = bevel(near, far, gap, hub, hub_end) + Pos(0, 0, near) * Cylinder(axle / 2, faces / 2 - near, align=UP)
    tyre = Pos(0, 0, faces / 2 - wheel_wide) * Cylinder(wheel / 2, wheel_wide, align=UP)
    return ALONG_X * (body + fillet(tyre.edges(), 2))


def spider(near, far, gap, hub, hub_end, pin, play):
    return bevel(near, far, gap, hub, hub_end) - Cylinder(pin / 2 + play, 4 * hub_end)


def cage(ring, ring_inner, ring_high, journal, journal_end, block_near, axle, pin, play):
    """A flat ring with the cross pin in it and a hollow journal on each side."""
    body = Cylinder(ring / 2, ring_high)
    for x in (-1, 1):
        body += Pos(x * (journal_end + ring_inner / 2) / 2, 0, 0) * ALONG_X * Cylinder(journal / 2, journal_end - ring_inner / 2)
        body += Pos(x * (block_near - 0.5 + ring_inner / 2) / 2, 0, 0) * ALONG_X * Cylinder(journal / 2 + 3, block_near - 0.5 - ring_inner / 2)
    body -= Cylinder(ring_inner / 2, 2 * ring) + ALONG_X * Cylinder(axle / 2 + play, 3 * ring)
    return body + ALONG_Y * Cylinder(pin / 2, (ring + ring_inner) / 2)


def housing(axle_z, block_near, block_far, journal, play, base=10, deep=110, block=44):
    body = fillet(Box(2 * block_far + 20, deep, base, align=UP).edges().filter_by(Axis.Z), 8)
    for x in (-1, 1):
        foot = Pos(x * (block_near + block_far) / 2, 0, 0)
        body += foot * Box(block_far - block_near, block, axle_z, align=UP) + foot * Pos(0, 0, axle_z) * ALONG_X * Cylinder(block / 2, block_far - block_near)
    return body - Pos(0, 0, axle_z) * ALONG_X * Cylinder(journal / 2 + play, 4 * block_far)
