from build123d import Cylinder, fillet


def roll(wheel_d, wheel_wide, axle_d, play):
    tread = Cylinder(wheel_d / 2, wheel_wide)
    return fillet(tread.edges(), 1.5) - Cylinder(axle_d / 2 + play, 2 * wheel_wide)
