from math import cos, radians, sin

from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, Sphere, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
AHEAD = (Align.CENTER, Align.MIN, Align.MIN)


def along_x(radius, low, high):
    return Pos(X=(low + high) / 2) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def stand(front, reach, column_d, play, head_z, head_top, head_wide, quill_d, star_z, shaft_d, hinge_y, hinge_z, pin_d, lug_x, lug, wide=200, deep=300, plate=20, head_front=-153, head_back=52):
    """Base, column and head in one piece; two lugs at the back take the cover's pins."""
    body = Pos(0, -front, 0) * Box(wide, deep, plate, align=AHEAD)
    body = chamfer(body.edges().filter_by(Axis.Z), 5)
    body += Cylinder(column_d / 2, head_z + 5, align=UP)
    head = Pos(0, head_front, head_z) * Box(head_wide, head_back - head_front, head_top - head_z, align=AHEAD)
    body += fillet(head.edges().filter_by(Axis.Y).group_by(Axis.Z)[0], 4)
    body -= Pos(0, -reach, head_z - 1) * Cylinder(quill_d / 2 + play, 96, align=UP)
    body -= Pos(0, -reach, star_z) * along_x(shaft_d / 2 + play, quill_d / 2 + 4, head_wide)
    for side in (-1, 1):
        ear = Pos(0, 0) * Circle(6) + Pos(-3.5, -8) * Rectangle(7, 16) + Pos(0, -7) * Rectangle(12, 14)
        ear -= Circle(pin_d / 2 + play)
        body += Pos(side * (lug_x + lug / 2) - lug / 2, hinge_y, hinge_z) * (Rot(0, 0, 90) * Rot(90, 0, 0) * extrude(ear, lug))
    return body


def table(reach, column_d, play, table_d, tall=50, disc=17, ring=80, hole=24):
    """Upper face at z = 0; the collar about the column."""
    body = Pos(0, -reach, 0) * Cylinder(table_d / 2, disc, align=DOWN) + Cylinder(ring / 2, tall, align=DOWN)
    body += Pos(0, -reach / 2, 0) * Box(50, reach, disc, align=DOWN)
    body -= Pos(0, -reach, 0) * Cylinder(hole / 2, 3 * disc)
    return body - Cylinder(column_d / 2 + play, 3 * tall)


def quill(quill_d, spindle_d, play, long=135):
    return Cylinder(quill_d / 2, long, align=UP) - Cylinder(spindle_d / 2 + play, 80, align=DOWN) - Cylinder(spindle_d / 2 + play, 80, align=UP)


def chuck(spindle_d, across=36, tall=43, nose=18, nose_high=12, gap=0.4):
    body = Pos(0, 0, -gap) * Cylinder(across / 2, tall, align=DOWN) + Pos(0, 0, -gap - tall) * Cylinder(nose / 2, nose_high, align=DOWN)
    body += Pos(0, 0, -gap) * Cylinder(spindle_d / 2, 70, align=UP)
    return body - Pos(0, 0, -gap - tall - nose_high) * Cylinder(4, 25, align=UP)


def star(shaft_d, head_wide, quill_d, hub_d=36, hub=29, arm=95, ball=20, bar=9, arm_x=15):
    """Outside the head's right face at x = 0."""
    body = along_x(hub_d / 2, 0.5, hub) + along_x(shaft_d / 2, -(head_wide / 2 - quill_d / 2 - 6), 2)
    for turn in (90, 210, 330):
        y, z = cos(radians(turn)), sin(radians(turn))
        body += Pos(arm_x, 0, 0) * Rot(turn - 90, 0, 0) * Cylinder(bar / 2, arm, align=UP)
        body += Pos(arm_x, arm * y, arm * z) * Sphere(ball / 2)
    return body


def cover(hinge_y, cover_low, head_wide, pin_d, lug_x, lug, tall=50, wall=3, inset=2, front=-151, back=47, barrel=4):
    """A hood about its hinge: open below, a barrel with two pins at the back."""
    low, wide = cover_low, head_wide - 2 * inset
    body = Pos(0, front - hinge_y, low) * Box(wide, back - front, tall, align=AHEAD)
    body -= Pos(0, front - hinge_y + wall, low - 1) * Box(wide - 2 * wall, back - front - 2 * wall, tall - wall + 1, align=AHEAD)
    knuckle = lug_x - 0.5
    body += along_x(barrel, -knuckle, knuckle) + Pos(0, back - hinge_y - 1, low) * Box(2 * knuckle, hinge_y - back + 1, 4, align=AHEAD)
    return body + along_x(pin_d / 2, -lug_x - lug, lug_x + lug)
