from build123d import Align, Axis, Box, Circle, Cylinder, Plane, Pos, Rectangle, RectangleRounded, Rot, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ACROSS = Rot(X=90)  # turns z into y


def _plate(thick, y, *circles):
    """A plate round circles (x, z, radius), its middle at y."""
    figure = make_hull([edge for x, z, r in circles for edge in (Pos(x, z) * Circle(r)).edges()])
    return Pos(0, y, 0) * extrude(Plane.XZ * figure, thick / 2, both=True)


def deck(deck_z, deck_thick, deck_wide, rear_x, rear_z, axle_d, leg_in, leg, hinge_x, hinge_z, pivot_d, play, lug_in, lug, flap_x, flap_z, flap_d, flap_half, start=104, end=500):
    """A board above z = 0; arms hold the rear axle, posts the flap, lugs the neck."""
    long = end - start
    board = Pos((start + end) / 2, 0, 0) * extrude(RectangleRounded(long, deck_wide, 6), deck_thick)
    body = chamfer(board.faces().sort_by(Axis.Z)[-1].edges(), 1)
    eye_z, hinge, flap = rear_z - deck_z, hinge_z - deck_z, flap_z - deck_z
    for side in (-1, 1):
        body += _plate(leg, side * (leg_in + leg / 2), (rear_x, eye_z, 12), (start + 8, deck_thick / 2, 9))
        body += _plate(leg - 3, side * (flap_half + 0.5 + (leg - 3) / 2), (flap_x, flap, 7), (flap_x, 8, 7))
        body += _plate(lug, side * (lug_in + lug / 2), (hinge_x, hinge, 12), (hinge_x + 11, 18, 8), (hinge_x - 11, 18, 8)) - _plate(60, 0, (hinge_x, -30, 30))
    body += Pos(rear_x, 0, eye_z) * ACROSS * Cylinder(axle_d / 2, 2 * leg_in + leg)
    body -= Pos(hinge_x, 0, hinge) * ACROSS * Cylinder(pivot_d / 2 + play, 100)
    return body - Pos(flap_x, 0, flap) * ACROSS * Cylinder(flap_d / 2 + play, 100)


def neck(hinge_x, hinge_z, front_x, head_low, head_high, stem_d, play, pivot_d, lug_in, lug, eye=12, head_d=38):
    """A tongue about the hinge, a bar forward, and the head tube."""
    x, low = front_x - hinge_x, head_low - hinge_z
    body = _plate(2 * lug_in - 0.8, 0, (0, 0, eye), (x - 12, 0, eye))
    body += Pos(x, 0, low + 0.3) * Cylinder(head_d / 2, head_high - head_low - 0.3, align=UP)
    body = chamfer([e for e in body.edges().filter_by(lambda e: e.geom_type.name == "CIRCLE" and abs(e.radius - head_d / 2) < 0.01 and e.length > 3 * e.radius)], 1)
    body -= Pos(x, 0, 0) * Cylinder(stem_d / 2 + play, 400)
    return body + ACROSS * Cylinder(pivot_d / 2, 2 * (lug_in + lug))


def fork(head_low, front_z, wheel_d, axle_d, leg_in, leg, stem_d, stem_top, post_d, play, crown=11, post_room=170):
    """Crown below z = 0 with two legs and the axle; above it the stem, bored for the handlebar."""
    axle, wide = front_z - head_low, 2 * (leg_in + leg)
    block = Box(28, wide, crown, align=DOWN)
    body = fillet(block.edges().filter_by(Axis.Z), 3)
    for side in (-1, 1):
        body += _plate(leg, side * (leg_in + leg / 2), (0, axle, 13), (0, -crown - 4, 13)) - Pos(0, 0, -2) * Box(80, 80, 80, align=UP)
    body += Pos(0, 0, axle) * ACROSS * Cylinder(axle_d / 2, 2 * leg_in + leg)
    tall = stem_top - head_low
    tube = Pos(0, 0, -1) * Cylinder(stem_d / 2, tall + 1, align=UP)
    body += chamfer(tube.edges().sort_by(Axis.Z)[-1], 1)
    return body - Pos(0, 0, tall) * Cylinder(post_d / 2 + play, post_room, align=DOWN)


def handlebar(stem_top, bar_z, post_d, bar_d=20, bar=360, below=165):
    """A post through z = 0 and a bar across."""
    rod = Pos(0, 0, -below) * Cylinder(post_d / 2, below + bar_z - stem_top, align=UP)
    grip = ACROSS * Cylinder(bar_d / 2, bar)
    return rod + Pos(0, 0, bar_z - stem_top) * fillet(grip.edges(), 2)


def front_wheel(wheel_d, wheel_wide, axle_d, play, hub_d=30):
    tyre = ACROSS * Cylinder(wheel_d / 2, wheel_wide)
    body = fillet(tyre.edges(), 5) + ACROSS * Cylinder(hub_d / 2, wheel_wide + 2)
    return body - ACROSS * Cylinder(axle_d / 2 + play, 3 * wheel_wide)


rear_wheel = front_wheel


def flap(flap_d, flap_half, leg, back=98, plate=5, barrel=6):
    """A plate towards -x with a barrel and two trunnions along y."""
    sheet = Pos(-back / 2, 0, -2) * Box(back, 2 * flap_half - 1, plate)
    body = fillet(sheet.edges().filter_by(Axis.Z).group_by(Axis.X)[0], 8)
    body += ACROSS * Cylinder(barrel, 2 * flap_half)
    return body + ACROSS * Cylinder(flap_d / 2, 2 * (flap_half + 0.5 + leg - 3))
