from build123d import Align, Box, Circle, Cylinder, Pos, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def earth(earth_r, earth_z, moon_z, level, globe_low, hub, bore_e, play, post_d, bar=5):
    """An arm with a stepped post: the Moon's hub rests on its shoulder, the globe sits on its end."""
    body = extrude(Circle(bore_e / 2 + 4), hub) + Pos(earth_r / 2, 0, 2) * Box(earth_r, post_d + 3, bar, align=UP)
    body += Pos(earth_r, 0, 2) * Cylinder(post_d / 2 + 1.5, moon_z - earth_z - 2, align=UP)
    body += Pos(earth_r, 0, 2) * Cylinder(post_d / 2, level - globe_low - earth_z - 2, align=UP)
    return body - Cylinder(bore_e / 2 + play, 3 * hub)
