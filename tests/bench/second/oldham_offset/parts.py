from build123d import Align, Box, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def frame(wide, deep, tall, plate, total, shaft_d, play, offset):
    """Two plates and a back wall on the side of +y."""
    low = (total - tall) / 2
    body = Pos(0, 0, low) * Box(wide, deep, tall, align=UP)
    body -= Pos(0, -plate, low + plate) * Box(2 * wide, deep, tall - 2 * plate, align=UP)
    body -= Pos(0, 0, total / 2) * Cylinder(shaft_d / 2 + play, total, align=UP)
    return body - Pos(offset, 0, -total / 2) * Cylinder(shaft_d / 2 + play, total, align=UP)


def hub(across, total, shaft_d, disc_d, disc, gap, tongue, tongue_wide):
    """About z above the floater's middle; its tongue lies along x or y."""
    face = disc / 2 + gap
    body = Pos(0, 0, face) * Cylinder(disc_d / 2, disc, align=UP) + Pos(0, 0, face) * Cylinder(shaft_d / 2, total / 2 - face, align=UP)
    size = (disc_d + 10, tongue_wide) if across else (tongue_wide, disc_d + 10)
    bar = Box(*size, tongue + 1, align=UP) & Cylinder(disc_d / 2, 4 * disc)
    return body + Pos(0, 0, face - tongue) * bar


def hub_upper(total, shaft_d, disc_d, disc, gap, tongue, tongue_wide):
    return hub(True, total, shaft_d, disc_d, disc, gap, tongue, tongue_wide)


def hub_lower(total, shaft_d, disc_d, disc, gap, tongue, tongue_wide):
    return hub(False, total, shaft_d, disc_d, disc, gap, tongue, tongue_wide)


def floater(disc_d, disc, tongue, tongue_wide, side):
    """Disc with a slot along x above and one along y below."""
    body, slot = Cylinder(disc_d / 2, disc), tongue_wide + 2 * side
    body -= Pos(0, 0, disc / 2 - tongue) * Box(2 * disc_d, slot, disc, align=UP)
    return body - Pos(0, 0, -disc / 2 + tongue) * Box(slot, 2 * disc_d, disc, align=(Align.CENTER, Align.CENTER, Align.MAX))
