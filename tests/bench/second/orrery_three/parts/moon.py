from build123d import Align, Box, Circle, Cylinder, Pos, Sphere, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def moon(moon_r, moon_z, level, post_d, play, ball_d=6, bar=3, wire=2.5):
    body = extrude(Circle(post_d / 2 + 2.5), bar + 2) + Pos(moon_r / 2, 0, 0) * Box(moon_r, wire, bar, align=UP)
    body += Pos(moon_r, 0, 0) * Cylinder(wire / 2, level - moon_z, align=UP) + Pos(moon_r, 0, level - moon_z) * Sphere(ball_d / 2)
    return body - Cylinder(post_d / 2 + play, 30)
