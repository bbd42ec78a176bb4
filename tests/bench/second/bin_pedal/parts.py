from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def block(x, y, z):
    """Return a box between two values of each coordinate."""
    return Pos(x[0], y[0], z[0]) * Box(x[1] - x[0], y[1] - y[0], z[1] - z[0], align=LOW)


def across(d, x, y, z):
    """A cylinder along y, between two values of y."""
    return Pos(x, (y[0] + y[1]) / 2, z) * Rot(X=90) * Cylinder(d / 2, y[1] - y[0])


def stud(d, x, z, root, tip, head_d=10, head=2):
    """A stud that points to -y, with a head beyond its tip."""
    return across(d, x, (tip - head, root), z) + across(head_d, x, (tip - head, tip), z)


def bin(long, wide, bin_z, wall, hinge_x, hinge_z, pivot_x, pivot_z, pin_d, play, layer, air, ear=6, ear_d=16):
    half = wide / 2
    body = block((0, long), (-half, half), (0, bin_z)) - block((wall, long - wall), (wall - half, half - wall), (wall, 2 * bin_z))
    y = (-half, ear - half)
    body += block((0, ear_d), y, (bin_z - 12, hinge_z)) + across(ear_d, hinge_x, y, hinge_z)
    body -= across(pin_d + 2 * play, hinge_x, (-wide, 3 * ear - half), hinge_z)
    return body + stud(pin_d, pivot_x, pivot_z, wall - half, -half - layer - 2 * air)


def pedal(arm, layer, air, pin_d, play, pivot_x, end_x, pad_y, inner_y, rod_d=14, pad=38, pad_wide=61, thick=6):
    """Lying along x about its pivot, its inner face at y = 0; a stud for the rod behind, the pad in front."""
    reach = end_x - pivot_x
    body = block((-arm, reach - pad + 1), (-layer, 0), (-rod_d / 2, rod_d / 2)) + across(rod_d, -arm, (-layer, 0), 0)
    body += block((reach - pad, reach), (inner_y - pad_y, inner_y - pad_y + pad_wide), (-thick / 2, thick / 2))
    body += stud(pin_d, -arm, 0, -layer / 2, -2 * layer - 2 * air)
    return body - across(pin_d + 2 * play, 0, (-3 * layer, layer), 0)


def rod(rod, layer, pin_d, play, wide=14):
    """Along z from its lower pin, its inner face at y = 0."""
    body = block((-wide / 2, wide / 2), (-layer, 0), (0, rod))
    for z in (0, rod):
        body += across(wide, 0, (-layer, 0), z)
        body -= across(pin_d + 2 * play, 0, (-2 * layer, layer), z)
    return body


def lid(long, wide, lid, hinge_x, tall, hinge_z, lever, layer, air, pin_d, inner_y, outer_y, ear=6, lug=14):
    """Plate above the hinge; its lug has the lever, a stud for the rod and one through the bin's ear."""
    top = tall - hinge_z
    body = block((3 - hinge_x, long + 3 - hinge_x), (-inner_y - layer, wide / 2 - 3), (top - lid, top))
    y = (-inner_y - layer, -inner_y)
    body += block((3 - hinge_x, lug / 2), y, (0, top)) + across(lug, 0, y, 0) - block((-lug, 3 - hinge_x), y, (0, top))
    body += block((0, lever), y, (-lug / 2, lug / 2)) + across(lug, lever, y, 0)
    end = ear + 2 * air - wide / 2
    body += across(pin_d, 0, (-inner_y - 1, end), 0) + across(11, 0, (end, end + 2), 0)
    return body + stud(pin_d, lever, 0, -inner_y - layer / 2, -outer_y - layer - air)
