from build123d import Align, Axis, Cone, Cylinder, Pos, Rot, Sphere, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_x(y, z, start, end, diameter):
    return Pos(start, y, z) * Rot(Y=90) * Cylinder(diameter / 2, end - start, align=UP)


def horn(
    lead_z,
    bell_z,
    bell_d,
    whole,
    horn_x,
    valve_x,
    pitch,
    casing_d,
    casing_low,
    casing_high,
    bore_d,
    piston_d,
    main_x,
    main_low,
    main_high,
    third_x,
    third_y,
    third_low,
    third_high,
    leg_d,
    play,
    pipe_d=13,
    pipe_bore=9,
    bell=81,
    sheet=2,
    tube_d=12,
):
    """Lead pipe, three casings, the outer tubes of both slides, the bell's pipe and the bell, soldered together."""
    neck, mouth = whole - bell, bell_d / 2
    last = valve_x + pitch
    body = along_x(0, lead_z, horn_x, valve_x - pitch, pipe_d) + along_x(0, bell_z, last, neck + 2, pipe_d)
    body += Pos(neck, 0, bell_z) * Rot(Y=90) * Cone(pipe_d / 2, mouth, bell, align=UP)
    for z in (main_low, main_high):
        body += along_x(0, z, last, main_x + 62, tube_d)
    for z in (third_low, third_high):
        body += along_x(third_y, z, valve_x - pitch - 22, last + 6, tube_d)
    for i in (-1, 0, 1):
        body += Pos(valve_x + i * pitch, 0, casing_low) * Cylinder(casing_d / 2 + 0.2, casing_high - casing_low, align=UP)
    body -= along_x(0, lead_z, horn_x - 1, valve_x - pitch, pipe_bore) + along_x(0, bell_z, last, neck + 9, pipe_bore)
    slope = (mouth - pipe_d / 2) / bell
    start = 8
    body -= Pos(neck + start, 0, bell_z) * Rot(Y=90) * Cone(pipe_d / 2 + slope * start - sheet, mouth - sheet, bell - start, align=UP)
    for z in (main_low, main_high):
        body -= along_x(0, z, last + 12, main_x + 70, leg_d + 2 * play)
    for z in (third_low, third_high):
        body -= along_x(third_y, z, valve_x - pitch - 30, third_x, leg_d + 2 * play)
    for i in (-1, 0, 1):
        body -= Pos(valve_x + i * pitch, 0, casing_low + 5) * Cylinder(bore_d / 2, casing_high, align=UP)
    return body


def mouthpiece(horn_x, pipe_bore=9, across=26, into=24):
    """Cup from x = 0 to the pipe, shank in the pipe."""
    body = along_x(0, 0, 0, horn_x, across)
    body = fillet(body.edges(), 2.5) + along_x(0, 0, horn_x - 1, horn_x + into, pipe_bore)
    return body - Sphere(8.5) - along_x(0, 0, 0, 2 * horn_x + into, 4)


def valve(piston_d, press, casing_high, casing_low, above=32, stem_d=6, button_d=17, button=5):
    """Piston below the casing's end, which is z = 0, with stem and button."""
    long = casing_high - casing_low - 5 - press - 6
    body = Pos(0, 0, -4) * Cylinder(piston_d / 2, long - 4, align=DOWN) + Pos(0, 0, -5) * Cylinder(stem_d / 2, above, align=UP)
    disc = Pos(0, 0, above - button) * Cylinder(button_d / 2, button, align=UP)
    return body + fillet(disc.edges().group_by(Axis.Z)[-1], 1.5)


def main_slide(main_low, main_high, leg_d):
    """Its end is at x = 0, its legs towards -x."""
    body = along_x(0, 0, -85, -4, leg_d) + along_x(0, main_high - main_low, -85, -4, leg_d)
    return body + Pos(-6, 0, -7) * Cylinder(6, main_high - main_low + 14, align=UP)


def third_slide(third_low, third_high, leg_d):
    """Its end is at x = 0, its legs towards +x."""
    body = along_x(0, 0, 4, 72, leg_d) + along_x(0, third_high - third_low, 4, 72, leg_d)
    return body + Pos(6, 0, -7) * Cylinder(6, third_high - third_low + 14, align=UP)
