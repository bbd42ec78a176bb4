from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, Sphere, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)
ALONG_X = Rot(Y=90)


def body(bore, long, across, ball_d, play, stem_d, neck_d, neck_top):
    """A round body along x with a spherical seat in its middle and a neck upwards."""
    barrel = ALONG_X * Cylinder(across / 2, long)
    shape = chamfer(barrel.edges().filter_by(lambda e: e.length > across), 1)
    neck = Cylinder(neck_d / 2, neck_top, align=UP)
    shape += chamfer(neck.edges().sort_by(Axis.Z)[-1], 0.8)
    shape -= ALONG_X * Cylinder(bore / 2, 2 * long)
    shape -= Sphere(ball_d / 2 + play)
    return shape - Cylinder(stem_d / 2 + play, 2 * neck_top, align=UP)


def ball(bore, ball_d, stem_d, lever_low, lever_thick, square):
    """A bored ball with a stem upwards, whose square end carries the lever."""
    shape = Sphere(ball_d / 2) + Pos(0, 0, ball_d / 2 - 2) * Cylinder(stem_d / 2, lever_low - ball_d / 2 + 2, align=UP)
    shape += Pos(0, 0, lever_low - 1) * Box(square, square, lever_thick + 1, align=UP)
    return shape - ALONG_X * Cylinder(bore / 2, 2 * ball_d)


def lever(lever_thick, square, lever_long, hub_d=32, wide=19.5):
    figure = Circle(hub_d / 2) + Pos(lever_long / 2, 0) * Rectangle(lever_long, wide)
    plate = extrude(figure, lever_thick)
    plate = fillet(plate.edges().filter_by(Axis.Z).group_by(Axis.X)[-1], 5)
    plate = chamfer(plate.faces().sort_by(Axis.Z)[-1].edges(), 0.6)
    return plate - Box(square, square, 60)
