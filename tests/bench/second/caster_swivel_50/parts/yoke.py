from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rectangle, extrude

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def yoke(plate, total, wheel_d, trail, king_d, crown, gap, axle_d, play, inner, leg, front=19, rear=33, leg_wide=18):
    """Crown below z = 0 with a bore for the king pin, two legs down to the axle."""
    wide = inner + 2 * leg
    body = Pos((front - rear) / 2, 0, 0) * Box(front + rear, wide, crown, align=DOWN)
    down = wheel_d / 2 - total + plate + gap  # height of the axle
    shape = Pos(-trail, down) * Circle(leg_wide / 2) + Pos(-trail, (down - 1) / 2) * Rectangle(leg_wide, -down - 1)
    shape -= Pos(-trail, down) * Circle(axle_d / 2)
    for y in (-inner / 2, wide / 2):
        body += Pos(0, y, 0) * (Plane.XZ * extrude(shape, leg))
    return body - Cylinder(king_d / 2 + play, 3 * crown)
