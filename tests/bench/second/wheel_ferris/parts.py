from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_y(start, end, radius):
    return Pos(0, start, 0) * Rot(X=-90) * Cylinder(radius, end - start, align=UP)


def stand(axis_z, axle_d, play, post_in, post, wide=240, deep=130, plate=10, post_wide=40, above=19):
    """A plate with two posts, bored for the axle."""
    body = Box(wide, deep, plate, align=UP)
    for side in (-1, 1):
        body += Pos(0, side * (post_in + post / 2), plate - 1) * Box(post_wide, post, axis_z + above - plate + 1, align=UP)
    return body - Pos(0, 0, axis_z) * along_y(-2 * deep, 2 * deep, axle_d / 2 + play)


def wheel(pin_r, arm_end, arm_wide, arm, arm_in, rod_d, axle_d, axle_half):
    """Axle, two stars of three crossed bars and the rods that join their ends."""
    body = along_y(-axle_half, axle_half, axle_d / 2)
    for side in (-1, 1):
        for i in range(3):
            body += Pos(0, side * (arm_in + arm / 2), 0) * Rot(Y=60 * i) * Box(2 * arm_end, arm, arm_wide)
    for i in range(6):
        body += Rot(Y=60 * i) * Pos(pin_r, 0, 0) * along_y(-arm_in - arm / 2, arm_in + arm / 2, rod_d / 2)
    return body


def gondola(rod_d, play, wide=40, deep=42, down=39, up=7, sheet=3, ear_wide=14):
    """Floor and two walls with eyes for the rod; it hangs from the origin."""
    body = Pos(0, 0, -down) * Box(wide, deep, sheet, align=UP)
    for side in (-1, 1):
        y = side * (deep - sheet) / 2
        body += Pos(0, y, -down) * Box(ear_wide, sheet, down, align=UP) + Pos(0, y, 0) * Rot(X=90) * Cylinder(up, sheet)
        body += Pos(side * (wide - sheet) / 2, 0, -down) * Box(sheet, deep, 9, align=UP)
    return body - along_y(-deep, deep, rod_d / 2 + play)


def crank(axle_d, axle_half, post_in, post, crank_r, hub_d=27, hub_front=1, arm_wide=12, grip_d=12, reach=32):
    """On the axle's front end, which is at the origin; the grip is at +x."""
    back = axle_half - post_in - post - 1
    body = along_y(-hub_front, back, hub_d / 2)
    body += Pos(crank_r / 2, (back - hub_front) / 2, 0) * Box(crank_r, back + hub_front, arm_wide) + Pos(crank_r, 0, 0) * along_y(
        -hub_front, back, arm_wide / 2
    )
    grip = along_y(-reach, 0, grip_d / 2)
    body += Pos(crank_r, 0, 0) * fillet(grip.edges().group_by(Axis.Y)[0], 2)
    return body - along_y(0, 2 * axle_half, axle_d / 2)
