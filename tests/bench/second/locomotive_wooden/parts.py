from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def _lying(radius, length):
    """A cylinder along x from the origin."""
    return Rot(Y=90) * Cylinder(radius, length, align=UP)


def boiler(boiler_d, boiler_long, chimney_d, chimney_x, boiler_x, chimney_above):
    seat = Pos(chimney_x - boiler_x, 0, chimney_above) * Cylinder(chimney_d / 2, boiler_d, align=UP)
    return _lying(boiler_d / 2, boiler_long) - seat


def chassis(chassis_long, wide, chassis_high, boiler_d, boiler_long, boiler_x, bed):
    """Its upper face is z = 0."""
    block = Box(chassis_long, wide, chassis_high, align=(Align.MIN, Align.CENTER, Align.MAX))
    return block - Pos(boiler_x, 0, boiler_d / 2 - bed) * _lying(boiler_d / 2, boiler_long)


def cab(wide, long=60, high=70, window_long=25, window_high=26, window_z=45):
    body = Box(long, wide, high, align=(Align.MIN, Align.CENTER, Align.MIN))
    return body - Pos(long / 2, 0, window_z) * Box(window_long, 2 * wide, window_high)


def chimney(chimney_d, chimney_long):
    return Cylinder(chimney_d / 2, chimney_long, align=UP)


def wheel(wheel_d, wheel_thick):
    """A disc towards +y."""
    return Rot(X=-90) * Cylinder(wheel_d / 2, wheel_thick, align=UP)


wheel_front = wheel_rear = wheel
