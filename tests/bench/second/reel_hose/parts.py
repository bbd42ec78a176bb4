from build123d import Align, Axis, Box, Cylinder, Pos, Rot, Sphere, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, low, high, y=0, z=0):
    return Pos((low + high) / 2, y, z) * Rot(0, 90, 0) * Cylinder(radius, high - low)


def frame(inner, side, outer, drum_z, axle_d, play, wheel_d, wheel_y, stub_d, stub_x, wheel_x, hinge_z, hinge_d, tall=469, wide=60, foot_y=-82, foot=20, bar_d=22, bar_z=38):
    """Two boards on edge with feet to the front and arms to the wheels' stubs, joined by a bar."""
    body = along_x(bar_d / 2, -inner - 2, inner + 2, 0, bar_z)
    for sign in (-1, 1):
        x = sign * (inner + side / 2)
        body += Pos(x, 0, 0) * Box(side, wide, tall, align=UP)
        body += Pos(x, foot_y, 0) * Box(side, -foot_y, foot, align=(Align.CENTER, Align.MIN, Align.MIN))
        body += Pos(x, 0, wheel_d / 2) * Box(side, wheel_y, 32, align=(Align.CENTER, Align.MIN, Align.CENTER))
        body += Pos(x, wheel_y, wheel_d / 2) * Rot(0, 90, 0) * Cylinder(16, side)
        body += along_x(stub_d / 2, min(sign * inner, sign * stub_x), max(sign * inner, sign * stub_x), wheel_y, wheel_d / 2)
    body -= along_x(axle_d / 2 + play, -2 * outer, 2 * outer, 0, drum_z)
    return body - along_x(hinge_d / 2 + play, -2 * outer, 2 * outer, 0, hinge_z)


def drum(inner, outer, drum_d, barrel_d, axle_d, throw, crank_x, grip_x, grip_pin_d, flange=7, gap=1, arm=10):
    """Flanges, barrel, axle and, outside on the right, the crank with the grip's pin."""
    end = inner - gap
    body = along_x(barrel_d / 2, -end, end)
    for low in (-end, end - flange):
        body += along_x(drum_d / 2, low, low + flange)
    body += along_x(axle_d / 2, -outer, grip_x - 0.5)
    body += Pos(grip_x - 0.5 - arm, 0, 0) * Box(arm, 22, throw, align=(Align.MIN, Align.CENTER, Align.MAX))
    body += along_x(11, grip_x - 0.5 - arm, grip_x - 0.5, 0, -throw)
    return body + along_x(grip_pin_d / 2, grip_x - arm, crank_x, 0, -throw)


def grip(grip_d, grip_pin_d, play, long=74):
    body = along_x(grip_d / 2, 0, long)
    body = fillet(body.edges(), 4)
    return body - along_x(grip_pin_d / 2 + play, -1, long + 1)


def wheel(wheel_d, wheel_wide, stub_d, play):
    """Along +x from its inner face."""
    body = along_x(wheel_d / 2, 0, wheel_wide)
    body = fillet(body.edges(), 3)
    for low in (-1, wheel_wide - 6):
        body -= along_x(wheel_d / 2 - 20, low, low + 7) - along_x(20, low - 1, low + 8)
    return body - along_x(stub_d / 2 + play, -1, wheel_wide + 1)


def handle(inner, outer, hinge_z, high, tube_d, rod_x, hinge_d):
    """A bow of tube over the hinge's axis, with pins into the side frames."""
    top = high - hinge_z - tube_d / 2
    body = along_x(tube_d / 2, -rod_x, rod_x, 0, top)
    for sign in (-1, 1):
        body += Pos(sign * rod_x, 0, 0) * Cylinder(tube_d / 2, top, align=UP) + Pos(sign * rod_x, 0, top) * Sphere(tube_d / 2)
        near, far = sign * (rod_x - 12), sign * (inner - 1)
        body += along_x(13, min(near, far), max(near, far))
        body += along_x(hinge_d / 2, min(near, sign * outer), max(near, sign * outer))
    return body
