from build123d import Align, Axis, Box, Circle, Cylinder, Plane, PolarLocations, Polygon, Pos, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)
ALONG_X = Rot(Y=90)


def _tail(tail_in, tail_out, tail, long, more=0.0):
    """A dovetail along y: narrow at z = 0, wide at z = tail; `more` widens it on all sides for a groove."""
    a, b = tail_in / 2 + more, tail_out / 2 + more
    face = Polygon((-a, -1), (a, -1), (a, 0), (b, tail + more), (-b, tail + more), (-a, 0), align=None)
    return extrude(Plane.XZ * face, long / 2, both=True)


def stand(optic_y, table_high, column_front, rail_low, stand_high, tail_in, tail_out, tail, light_d, knob_y, knob_z, shaft_d, mirror_y, mirror_z, axle_d, play,
          wide=110, deep=160, foot=17, column_x=40, column_y=29, table_front=38, table_x=90, table=14, post=6, post_x=28):
    body = Pos(0, 0, 0) * Box(wide, deep, foot, align=FRONT)
    body = fillet(body.edges().filter_by(Axis.Z), 3)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    column = Pos(0, column_front, foot - 1) * Box(column_x, column_y, stand_high - foot + 1, align=FRONT)
    body += chamfer(column.edges().group_by(Axis.Z)[-1], 1)
    body += Pos(0, table_front, table_high - table) * Box(table_x, column_front - table_front + 2, table, align=FRONT)
    body += Pos(0, optic_y, table_high) * _tail(tail_in, tail_out, tail, 2 * (optic_y - table_front))
    rail = _tail(tail_in, tail_out, tail, stand_high - rail_low)
    body += Pos(0, column_front, (rail_low + stand_high) / 2) * Rot(X=90) * rail
    body -= Pos(0, optic_y, table_high) * Cylinder(light_d / 2, 60)
    body -= Pos(0, knob_y, knob_z) * ALONG_X * Cylinder(shaft_d / 2 + play, 2 * column_x)
    for side in (-1, 1):
        x = side * (post_x + post / 2)
        leg = Pos(x, mirror_y, foot - 1) * Box(post, 15, mirror_z - foot + 1, align=UP) + Pos(x, mirror_y, mirror_z) * ALONG_X * Cylinder(7.5, post)
        body += leg - Pos(x, mirror_y, mirror_z) * ALONG_X * Cylinder(axle_d / 2 + play, 4 * post)
    return body


def lower_slide(tail_in, tail_out, tail, light_d, play, table_high, lower_high, wide=110, deep=54):
    """On z = 0, with a groove along y below and a dovetail along x above."""
    tall = lower_high - table_high - 0.2
    body = Pos(0, 0, 0.2) * Box(wide, deep, tall - 0.2, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 0.6)
    body -= _tail(tail_in, tail_out, tail, 2 * deep, play)
    body += Pos(0, 0, tall) * Rot(Z=90) * _tail(tail_in, tail_out, tail, wide)
    return body - Cylinder(light_d / 2, 60)


def upper_slide(tail_in, tail_out, tail, light_d, play, wide=120, deep=51, tall=9.6):
    body = Box(wide, deep, tall, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 0.6)
    body -= Pos(0, 0, -0.2) * Rot(Z=90) * _tail(tail_in, tail_out, tail, 2 * wide, play)
    return body - Cylinder(light_d / 2, 60)


def tube(optic_y, column_front, tube_low, tail_in, tail_out, tail, play, spigot_d, tube_d=32, shoulder=287, eye_d=24, top=316, bore=18, block_low=176, block_high=235,
         block_x=40):
    """Upright about z from z = 0; behind it a block with a groove for the column's dovetail."""
    back = column_front - optic_y - 0.2
    block = Pos(0, 8, block_low - tube_low) * Box(block_x, back - 8, block_high - block_low, align=FRONT)
    block = fillet(block.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 4)
    body = block + Cylinder(tube_d / 2, shoulder - tube_low, align=UP)
    eye = Pos(0, 0, shoulder - tube_low - 1) * Cylinder(eye_d / 2, top - shoulder + 1, align=UP)
    body += fillet(eye.edges().sort_by(Axis.Z)[-1], 1.5)
    body -= Pos(0, back + 0.2, (block_low + block_high) / 2 - tube_low) * Rot(X=90) * _tail(tail_in, tail_out, tail, 200, play)
    body -= Cylinder(bore / 2, 400, align=UP)
    body -= Cylinder(spigot_d / 2 + play, 12, align=UP)
    return body - Pos(0, 0, 7 - play) * Cylinder(spigot_d / 2 + 1 + play, 2 + 2 * play, align=UP)


def nosepiece(spigot_d, across=45, tall=10.8, lens_d=11, lens=20, lens_r=14.5, lens_count=3, bore=10):
    """A disc below z = 0 with three objectives; its spigot above snaps into the tube with a bead."""
    disc = Pos(0, 0, -0.2) * Cylinder(across / 2, tall, align=DOWN)
    disc = chamfer(disc.edges(), 1)
    body = disc + Pos(0, 0, -1) * Cylinder(spigot_d / 2, 12, align=UP) + Pos(0, 0, 7) * Cylinder(spigot_d / 2 + 1, 2, align=UP)
    body -= Cylinder(bore / 2, 80)
    for place in PolarLocations(lens_r, lens_count, 90):
        barrel = Pos(0, 0, -tall + 0.8) * Cylinder(lens_d / 2, lens + 0.8, align=DOWN)
        body += place * chamfer(barrel.edges().sort_by(Axis.Z)[0], 1.5)
    return body


def focus_knob(shaft_d, start=-20, knob_from=20.3, knob_to=40, knob_d=35, end=47.5, stub_d=11):
    body = Pos(start, 0, 0) * ALONG_X * Cylinder(shaft_d / 2, knob_to - start, align=UP)
    grip = Pos(knob_from, 0, 0) * ALONG_X * Cylinder(knob_d / 2, knob_to - knob_from, align=UP)
    body += fillet(grip.edges(), 1)
    stub = Pos(knob_to - 1, 0, 0) * ALONG_X * Cylinder(stub_d / 2, end - knob_to + 1, align=UP)
    return body + chamfer(stub.edges().sort_by(Axis.X)[-1], 0.8)


def mirror(axle_d, across=52, thick=4.5, half=34):
    """An upright disc that faces -y, with an axle along x."""
    disc = Rot(X=90) * Cylinder(across / 2, thick)
    return chamfer(disc.edges(), 0.5) + ALONG_X * Cylinder(axle_d / 2, 2 * half)
