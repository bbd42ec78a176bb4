from build123d import Align, Cylinder, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def gland(nut, nut_high, stem_d, play, spigot_d, spigot, spanner_d=3):
    """A round nut above z = 0, with four holes for a pin spanner, and its spigot below."""
    body = Cylinder(nut / 2, nut_high, align=UP) + Cylinder(spigot_d / 2, spigot, align=(Align.CENTER, Align.CENTER, Align.MAX))
    for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        body -= Pos(x * 0.37 * nut, y * 0.37 * nut, nut_high) * Cylinder(spanner_d / 2, nut_high)
    return body - Cylinder(stem_d / 2 + play, 4 * nut_high)
