from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)
MIN_X = (Align.MIN, Align.CENTER, Align.CENTER)
X, Y = Rot(Y=90), Rot(X=90)


def stand(long, wide, base, in_x, out_x, block, centre_x, centre_z, bend_deg, shaft_d, play, in_top=88, out_top=67):
    body = Box(long, wide, base, align=(Align.MIN, Align.CENTER, Align.MIN))
    for x, top in ((in_x, in_top), (out_x, out_top)):
        body += Pos(x, 0, 0) * Box(block, wide, top, align=(Align.MIN, Align.CENTER, Align.MIN))
    bore = X * Cylinder(shaft_d / 2 + play, long, align=UP)
    body -= Pos(-long / 2 - 35, 0, centre_z) * bore
    return body - Pos(centre_x, 0, centre_z) * Rot(Y=bend_deg) * Pos(20, 0, 0) * bore


def yoke(shaft_end, d):
    """Fork along +x with its bores along z, the shaft behind it."""
    body = Pos(d["root"], 0, 0) * Box(d["arm"] + 1, d["wide"], d["fork"], align=(Align.MAX, Align.CENTER, Align.CENTER))
    for side in (-1, 1):
        z = side * (d["fork"] - d["arm"]) / 2
        body += Pos(0, 0, z) * Box(d["root"], d["wide"], d["arm"], align=MIN_X) + Pos(0, 0, z) * Cylinder(d["wide"] / 2, d["arm"])
    body += Pos(d["root"] - 1, 0, 0) * X * Cylinder(d["shaft_d"] / 2, shaft_end - d["root"] + 1, align=UP)
    return body - Cylinder(d["pin_d"] / 2 + d["play"], 2 * d["fork"])


def input(fork, arm, root, shaft_d, pin_d, play, centre_x, in_end, fork_wide=14):
    return Rot(Z=180) * yoke(centre_x - in_end, {"fork": fork, "arm": arm, "root": root, "shaft_d": shaft_d, "pin_d": pin_d, "play": play, "wide": fork_wide})


def output(fork, arm, root, shaft_d, pin_d, play, out_end, fork_wide=14):
    return Rot(X=90) * yoke(out_end, {"fork": fork, "arm": arm, "root": root, "shaft_d": shaft_d, "pin_d": pin_d, "play": play, "wide": fork_wide})


def cross(pin_d, fork, hub=14):
    return Cylinder(pin_d / 2, fork - 1) + Y * Cylinder(pin_d / 2, fork - 1) + Sphere(hub / 2)
