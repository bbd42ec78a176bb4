from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)
X = Rot(Y=90)


def ring(across, long, bore, neck_top, shaft_d, play, neck_d=34, blind=18):
    """The ring about x with its neck; the shaft's bore ends blind below."""
    body = X * Cylinder(across / 2, long) + Pos(Z=bore / 2 + 5) * Cylinder(neck_d / 2, neck_top - bore / 2 - 5, align=UP)
    body -= X * Cylinder(bore / 2, 2 * long)
    return body - Pos(Z=-bore / 2 - blind) * Cylinder(shaft_d / 2 + play, neck_top + bore, align=UP)


def flap(bore, rim, shaft_d, top, thick=9, low=17.6):
    """A slice of a ball across x, forged with its shaft."""
    disc = Sphere(rim) & Box(thick, 3 * rim, 3 * rim)
    foot = bore / 2 + low
    return disc + Pos(Z=-foot) * Cylinder(shaft_d / 2, foot + top, align=UP)


def lever(shaft_d, hub_high, reach, hub_d=30, wide=18, thick=6):
    body = Cylinder(hub_d / 2, hub_high, align=UP)
    body += Pos(Z=3) * Box(wide, reach, thick, align=(Align.CENTER, Align.MIN, Align.MIN))
    return body - Cylinder(shaft_d / 2, 4 * hub_high)
