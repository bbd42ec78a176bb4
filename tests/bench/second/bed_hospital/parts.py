from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
FORE = (Align.CENTER, Align.MIN, Align.CENTER)
AFT = (Align.CENTER, Align.MAX, Align.CENTER)


def along_x(radius, long):
    return Rot(0, 90, 0) * Cylinder(radius, long)


def bedstead(wide, long, top_z, beam, beam_high, pin_z, back_y, thigh_y, half, pin, play, post_x, post, rail_y, post_apart, out_x, sleeve_low, sleeve_high):
    """Two side beams on four legs, a head board, stretchers below and the fixed seat; sleeves for the side rails."""
    inner = wide - 2 * beam
    body = Pos(0, (back_y + thigh_y) / 2, top_z - 3) * Box(inner + 2, back_y - thigh_y - 2 * half - 8, 20, align=DOWN)
    body += Pos(0, long / 2 - 7, top_z) * Box(inner + 2, 14, 60, align=DOWN)
    for x in (-1, 1):
        body += Pos(x * (wide - beam) / 2, 0, top_z) * Box(beam, long, beam_high, align=DOWN)
        for y in (-1, 1):
            body += Pos(x * (wide - beam) / 2, y * (long / 2 - 25)) * Box(beam, 50, top_z - 10, align=UP)
            near = Pos(x * (wide / 2 + out_x - 5) / 2, rail_y + y * post_apart / 2, sleeve_low)
            body += near * Box(out_x - wide / 2 + 5, 44, sleeve_high - sleeve_low, align=UP)
            body -= Pos(x * post_x, rail_y + y * post_apart / 2, 0) * Cylinder(post + play, 2 * top_z)
    body -= Pos(0, (back_y + thigh_y) / 2, top_z - 100) * Box(inner, long - 30, 50)
    for y in (-1, 1):
        body += Pos(0, y * (long / 2 - 20), 160) * Box(inner + 2, 40, 60, align=UP)
    for y in (back_y, thigh_y):
        body -= Pos(0, y, pin_z) * along_x(pin + play, 2 * wide)
    return body


def back(half, back_long, back_wide, panel, pin):
    body = along_x(half, panel) + Box(panel, back_long, 2 * half, align=FORE)
    return body + along_x(pin, back_wide)


def thigh(half, thigh_y, calf_y, calf_wide, back_wide, panel, pin, stub):
    """A board with arms that hold the calf rest between them on inward stubs."""
    long = thigh_y - calf_y
    body = along_x(half, panel) + along_x(pin, back_wide) + Box(panel, long - half - 2, 2 * half, align=AFT)
    for x in (-1, 1):
        arm = Pos(x * (panel + calf_wide + 1) / 4, 0, 0)
        body += arm * Box((panel - calf_wide - 1) / 2, long, 2 * half, align=AFT)
        body += arm * Pos(0, -long, 0) * along_x(half, (panel - calf_wide - 1) / 2)
        body += Pos(x * (calf_wide / 2 - 2), -long, 0) * along_x(stub, 40)
    return body


def calf(half, calf_long, calf_wide, stub, play):
    body = along_x(half, calf_wide) + Box(calf_wide, calf_long, 2 * half, align=AFT)
    for x in (-1, 1):
        body -= Pos(x * calf_wide / 2, 0, 0) * along_x(stub + play, 50)
    return body


def guard(post, post_apart, rail_low, rail_high, sleeve_low, bar=35, thick=22, long=700):
    high = rail_high - rail_low
    body = Box(thick, long, high, align=UP) - Pos(0, 0, bar) * Box(2 * thick, long - 2 * bar, high - 2 * bar, align=UP)
    for y in (-1, 1):
        body += Pos(0, y * post_apart / 2, bar / 2) * Cylinder(post, rail_low - sleeve_low - 10 + bar / 2, align=DOWN)
    return body
