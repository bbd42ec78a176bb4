from build123d import Align, Axis, Box, Circle, Cone, Cylinder, Pos, Rectangle, Rot, Sphere, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
BACK = Rot(X=-90)  # turns z to +y


def _disc(across, tall):
    disc = Cylinder(across / 2, tall, align=UP)
    return chamfer(disc.edges(), 1)


def stand(foot_x, foot_y, foot, head_low, head_high, mid_y, spindle_x, idler_x, idler_y, motor_x, axle_d, play, belt_high, sleeve_d, boss_high, quill_d,
          feed_x, feed_z, feed_d, column_x=175, column_d=36, head_x=274, head_left=7, head_y=110, housing_low=233, boss_d=36, house_x=52, house_y=60):
    """Foot, column, head plate with two axles, and the housing of the quill with the bearing of the feed shaft."""
    plate = Box(foot_x, foot_y, foot, align=CORNER)
    body = chamfer(plate.edges().group_by(Axis.Z)[-1], 1)
    body += Pos(column_x, mid_y, foot / 2) * Cylinder(column_d / 2, head_low - foot / 2 + 1, align=UP)
    head = Pos(head_left, mid_y - head_y / 2, head_low) * Box(head_x - head_left, head_y, head_high - head_low, align=CORNER)
    body += fillet(head.edges().filter_by(Axis.Z), 1)
    body += Pos(spindle_x, mid_y, housing_low) * Box(house_x, house_y, head_low - housing_low + 1, align=UP)
    body += Pos(spindle_x, mid_y, head_low) * Cylinder(15, head_high - head_low + boss_high, align=UP)
    body += Pos(feed_x, mid_y - house_y / 2, feed_z) * BACK * Cylinder(boss_d / 2, house_y, align=UP)
    body -= Pos(spindle_x, mid_y, housing_low - 1) * Cylinder(quill_d / 2 + play, head_high - 2 - housing_low, align=UP)
    body -= Pos(spindle_x, mid_y, head_low) * Cylinder(sleeve_d / 2 + play, 40, align=UP)
    body -= Pos(feed_x, 0, feed_z) * BACK * Cylinder(feed_d / 2 + play, mid_y + house_y / 2 - 8, align=UP)
    for x, y, tall in ((idler_x, idler_y, 2 * belt_high + 1), (motor_x, mid_y, belt_high)):
        body += Pos(x, y, head_low) * Cylinder(axle_d / 2, head_high - head_low + tall, align=UP)
    return body


def motor_pulley(pulley_d, belt_high, axle_d, play):
    return Pos(0, 0, 0.3) * (_disc(pulley_d, belt_high - 0.6) - Cylinder(axle_d / 2 + play, 60))


def idler(idler_d, idler_small, belt_high, axle_d, play):
    body = _disc(idler_d, belt_high) + Pos(0, 0, belt_high - 2) * _disc(idler_small, belt_high + 2)
    return Pos(0, 0, 0.3) * (body - Cylinder(axle_d / 2 + play, 100))


def _flats(across_round, across_flats, tall):
    return extrude(Circle(across_round / 2) & Rectangle(2 * across_round, across_flats), tall)


def spindle_pulley(pulley_d, belt_high, sleeve_d, boss_high, spindle_d, across, play):
    """A disc on the boss, with a sleeve that turns in it and a bore with two flats."""
    body = Pos(0, 0, 0.3) * _disc(pulley_d, belt_high) + Pos(0, 0, -boss_high) * Cylinder(sleeve_d / 2, boss_high + 2, align=UP)
    return body - Pos(0, 0, -60) * _flats(spindle_d + 2 * play, across + 2 * play, 120)


def quill(quill_d, quill_low, quill_high, flat, spindle_d, play, collar_d=22, collar=6):
    """A sleeve upwards from z = 0 with a flat for the rack towards +x and a recess at its top."""
    tall = quill_high - quill_low
    body = Cylinder(quill_d / 2, tall, align=UP)
    body = chamfer(body.edges(), 1)
    body -= Pos(flat, 0, 0) * Box(quill_d, quill_d, 3 * tall, align=(Align.MIN, Align.CENTER, Align.CENTER))
    body -= Cylinder(spindle_d / 2 + play, 3 * tall)
    return body - Pos(0, 0, tall - collar) * Cylinder(collar_d / 2 + play, collar, align=UP)


def spindle(quill_low, quill_high, spindle_d, across, top, chuck_d=34, chuck=34, bit_d=8, bit=30, collar_d=22, collar=5.4):
    """A shaft upwards from z = 0 with a collar in the quill's recess, two flats above it, and a chuck with a bit below."""
    tall = quill_high - quill_low
    body = Pos(0, 0, -1) * Cylinder(spindle_d / 2, tall + 1, align=UP) + Pos(0, 0, tall - collar) * Cylinder(collar_d / 2, collar, align=UP)
    body += Pos(0, 0, tall - 1) * _flats(spindle_d, across, top - quill_high + 1)
    jaws = Pos(0, 0, -0.3 - chuck) * Cylinder(chuck_d / 2, chuck, align=UP)
    body += chamfer(jaws.edges(), 2)
    body += Pos(0, 0, -chuck - bit + 3) * Cylinder(bit_d / 2, bit, align=UP)
    return body + Pos(0, 0, -chuck - bit) * Cone(0.4, bit_d / 2, 3, align=UP)


def feed_lever(mid_y, feed_d, pinion_r, play, house_y=60, hub=28, hub_front=-6, hub_long=18, neck=14, arm_d=8, arm=110, ball_r=9):
    """A shaft along y with the pinion's pitch cylinder in its bearing, a hub in front and a lever upwards."""
    front = mid_y - house_y / 2
    body = Pos(0, front, 0) * BACK * Cylinder(pinion_r, house_y - 10, align=UP)
    body += Pos(0, 0, 0) * BACK * Cylinder(neck / 2, front + 1, align=UP)
    knob = Pos(0, hub_front, 0) * BACK * Cylinder(hub / 2, hub_long, align=UP)
    body += chamfer(knob.edges(), 1)
    middle = hub_front + hub_long / 2
    body += Pos(0, middle, 0) * Cylinder(arm_d / 2, arm, align=UP)
    return body + Pos(0, middle, arm) * Sphere(ball_r)
