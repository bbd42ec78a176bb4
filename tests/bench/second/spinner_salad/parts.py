from build123d import Align, Axis, Box, Circle, Cylinder, PolarLocations, Pos, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def _cup(across, tall, wall, rounding):
    """An open vessel on z = 0 with a rounded foot."""
    outer = fillet(Cylinder(across / 2, tall, align=UP).edges().sort_by(Axis.Z)[0], rounding)
    inner = Pos(0, 0, wall) * fillet(Cylinder(across / 2 - wall, tall, align=UP).edges().sort_by(Axis.Z)[0], rounding - wall + 1)
    return outer - inner


def bowl(bowl_d, bowl_high, wall, peg_d, peg_top):
    body = _cup(bowl_d, bowl_high, wall, 18)
    peg = Pos(0, 0, wall / 2) * Cylinder(peg_d / 2, peg_top - wall / 2, align=UP)
    return body + fillet(peg.edges().sort_by(Axis.Z)[-1], 1)


def basket(basket_d, basket_high, basket_low, peg_d, peg_top, play, wall=2.5, hub_d=24, slot=7, slot_high=74, slots_count=24, rows_count=12):
    """A perforated cup whose hub stands on the peg."""
    body = _cup(basket_d, basket_high, wall, 12)
    hub = peg_top - basket_low + 4
    body += fillet(Cylinder(hub_d / 2, hub, align=UP).edges().sort_by(Axis.Z)[-1], 2)
    body -= Pos(0, 0, -1) * Cylinder(peg_d / 2 + play, hub - 3 + play, align=UP)
    for place in PolarLocations(basket_d / 2, slots_count):
        body -= place * Pos(0, 0, 24) * Box(20, slot, slot_high, align=UP)
    for place in PolarLocations(basket_d / 3, rows_count):
        body -= place * Cylinder(5, 20)
    return body


def lid(bowl_d, wall, lid_thick, shaft_d, play, boss, lip=8):
    """A disc on z = 0 with a lip inside the bowl, and a bearing for the crank in the middle."""
    body = Cylinder(bowl_d / 2, lid_thick, align=UP)
    body = fillet(body.edges().sort_by(Axis.Z)[-1], 2)
    r = bowl_d / 2 - wall - 0.5
    body += Pos(0, 0, 1) * (Cylinder(r, lip + 1, align=DOWN) - Cylinder(r - 2.5, lip + 1, align=DOWN))
    body += Pos(0, 0, 1 - boss) * Cylinder(shaft_d / 2 + 4, boss + 3 + lid_thick, align=UP)
    return body - Cylinder(shaft_d / 2 + play, 4 * boss)


def crank(bowl_high, lid_thick, arm_z, arm, shaft_d, boss, clip_high, throw, pin_d, knob_high):
    """An arm above z = 0, the shaft below it, a pin with a head at its end."""
    low = bowl_high - boss - clip_high - arm_z
    body = Pos(0, 0, low) * Cylinder(shaft_d / 2, 2 - low, align=UP)
    body += Pos(0, 0, bowl_high + lid_thick + 5 - arm_z) * Cylinder(shaft_d / 2 + 4, arm_z - bowl_high - lid_thick - 4, align=UP)
    figure = make_hull([*Circle(14).edges(), *(Pos(throw, 0) * Circle(10)).edges()])
    bar = extrude(figure, arm)
    body += fillet(bar.faces().sort_by(Axis.Z)[-1].edges(), 1)
    body += Pos(throw, 0, arm - 1) * Cylinder(pin_d / 2, knob_high - 4, align=UP)
    return body + Pos(throw, 0, arm + knob_high - 5.5) * Cylinder(pin_d / 2 + 2, 2.5, align=UP)


def clip(shaft_d, clip_high, wide=5):
    ring = Pos(0, 0, 0.5) * Cylinder(shaft_d / 2 + wide, clip_high, align=DOWN)
    ring = chamfer(ring.edges().sort_by(Axis.Z)[0], 1)
    return ring - Cylinder(shaft_d / 2, 4 * clip_high)


def knob(pin_d, play, knob_high, across=26):
    """A knob with a bore from below and a wider room for the pin's head above."""
    body = Pos(0, 0, 0.3) * Cylinder(across / 2, knob_high, align=UP)
    body = fillet(body.edges().sort_by(Axis.Z)[-1], 3)
    body -= Cylinder(pin_d / 2 + play, 3 * knob_high)
    return body - Pos(0, 0, knob_high - 5.8) * Cylinder(pin_d / 2 + 2.4, knob_high, align=UP)
