from build123d import Align, Axis, Box, Circle, Cylinder, PolarLocations, Pos, Rot, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def body(side, box_high, hopper_high, hopper_d, hole_y, hole_d, pivot_x, pivot_y, pivot_d, shaft_d, play, drawer_x, drawer_z, drawer_low, air,
         board=9, sheet=2.5, fall_count=6):
    """A wooden box with a room for the drawer; on it a brass hopper, open into the box through holes round the crank's bearing."""
    box = Box(side, side, box_high, align=UP)
    box = fillet(box.edges().filter_by(Axis.Z), 2)
    box = chamfer(box.edges().group_by(Axis.Z)[-1], 1)
    box -= Pos(0, -side / 2 - 1, drawer_low - air) * Box(drawer_x + 2 * air, side - board + 1, drawer_z + 2 * air, align=FRONT)
    chute = drawer_low + drawer_z
    box -= Pos(0, 0, chute) * Cylinder(30, box_high - 14 - chute, align=UP)
    hopper = Cylinder(hopper_d / 2, hopper_high, align=UP)
    hopper = chamfer(hopper.edges().sort_by(Axis.Z)[-1:], 1) - Cylinder(hopper_d / 2 - sheet, hopper_high - sheet, align=UP)
    hopper -= Pos(0, hole_y, 0) * Cylinder(hole_d / 2, 3 * hopper_high)
    hopper += Pos(0, 0, hopper_high) * (Pos(pivot_x, pivot_y, -1) * Cylinder(pivot_d / 2, 3.2, align=UP) + Pos(pivot_x, pivot_y, 2.2) * Cylinder(4, 1.8, align=UP))
    box += Pos(0, 0, box_high) * hopper
    box -= Cylinder(shaft_d / 2 + play, 4 * box_high)
    for place in PolarLocations(18, fall_count):
        box -= Pos(0, 0, box_high - 20) * place * Cylinder(6, 22, align=UP)
    return box


def drawer(side, drawer_x, drawer_z, back=98, wall=5, front=8, knob_d=14, knob=14):
    """Its front in y = 0, its lower edge in z = 0."""
    body = Box(drawer_x, back, drawer_z, align=FRONT)
    body = chamfer(body.faces().sort_by(Axis.Y)[0].edges(), 0.8)
    body -= Pos(0, front, wall) * Box(drawer_x - 2 * wall, back - front - wall, drawer_z, align=FRONT)
    pull = Pos(0, 1, drawer_z / 2) * Rot(X=90) * Cylinder(knob_d / 2, knob + 1, align=UP)
    return body + fillet(pull.faces().sort_by(Axis.Y)[0].edges(), 2)


def cover(pivot_x, pivot_y, hole_y, pivot_d, play, thick=1.6, disc_d=22, eye_d=11):
    """A small plate above z = 0 from its eye at the origin to the disc that covers the hole."""
    disc, eye = Pos(-pivot_x, hole_y - pivot_y) * Circle(disc_d / 2), Circle(eye_d / 2)
    figure = make_hull([*(Pos(-pivot_x, hole_y - pivot_y) * Circle(4)).edges(), *Circle(4).edges()]) + disc + eye - Circle(pivot_d / 2 + play)
    return Pos(0, 0, 0.1) * extrude(figure, thick)


def crank(top, box_high, throw, arm_low, arm_high, shaft_d, pin_d, knob_high, hub_d=18, collar_d=13):
    """Shaft down from z = 0, an arm above, and a riveted pin for the knob."""
    low, high = arm_low - top, arm_high - top
    shaft = Pos(0, 0, box_high - 14 - top) * Cylinder(shaft_d / 2, high - box_high + 14 + top - 1, align=UP)
    arm = make_hull([*Circle(hub_d / 2).edges(), *(Pos(throw, 0) * Circle(6)).edges()])
    arm = extrude(arm, high - low)
    arm = chamfer(arm.edges().group_by(Axis.Z)[-1], 0.6)
    body = shaft + Pos(0, 0, low) * arm + Pos(0, 0, 0.2) * Cylinder(collar_d / 2, 2, align=UP)
    end = high + knob_high + 0.6
    body += Pos(throw, 0, high - 1) * Cylinder(pin_d / 2, end - high + 1, align=UP)
    return body + Pos(throw, 0, end) * Cylinder(4, 49 - end, align=UP)


def knob(pin_d, play, knob_high, across=22):
    wood = Pos(0, 0, 0.3) * Cylinder(across / 2, knob_high, align=UP)
    return fillet(wood.edges(), 1.5) - Cylinder(pin_d / 2 + play, 3 * knob_high)
