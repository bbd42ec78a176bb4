from build123d import Align, Box, Circle, Cylinder, Pos, Rectangle, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = Rot(-90, 0, 0)


def collar(high, rod_x, rod_z, lug_wide, hole, outside=47, bore=34.9, lip_bore=31.8, lip=3, lug_end=42, slit=3, mark=3, mark_x=20.5):
    flat = Circle(outside / 2) + Pos(lug_end / 2, 0) * Rectangle(lug_end, lug_wide)
    flat -= Circle(lip_bore / 2) + Pos(lug_end, 0) * Rectangle(2 * lug_end, slit) + Pos(-mark_x, 0) * Circle(mark / 2)
    body = extrude(flat, high) - Cylinder(bore / 2, high - lip, align=UP)
    return body - Pos(rod_x, -lug_wide, rod_z) * BACK * Cylinder(hole / 2, 2 * lug_wide, align=UP)


def nut(nut, rod_d, across=15):
    """From y = 0 towards -y."""
    return Pos(0, -nut, 0) * BACK * extrude(Circle(across / 2) - Circle(rod_d / 2), nut)


def washer(washer, hole, across=20):
    return BACK * extrude(Circle(across / 2) - Circle(hole / 2), washer)


def rod(pin_d, lever_high, rod_d, pivot_high):
    return Cylinder(pin_d / 2, lever_high) + Pos(0, -pivot_high, 0) * BACK * Cylinder(rod_d / 2, pivot_high, align=UP)


def lever(eye_d, lever_high, cam_d=17, off=1.5, bar=9, start=10, end=70, fork=8):
    """The eye at the origin, the bar along x, the cam's high side towards -y."""
    flat = Pos(0, -off) * Circle(cam_d / 2) + Pos(end / 2, 0) * Rectangle(end, bar) - Circle(eye_d / 2)
    body = extrude(flat, lever_high / 2, both=True)
    return body - Pos(start, 0, 0) * Box(4 * start, 4 * cam_d, fork, align=(Align.MAX, Align.CENTER, Align.CENTER))
