from build123d import Align, Cylinder, Polyline, Pos, Rot, extrude, make_face

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def clamp(clamp_high, bridge, boss_high, thread, wide=22, span=82, leg=8, lip=4.6, lip_high=7.6, boss=22):
    half, low = span / 2, bridge - clamp_high
    inner = half - leg
    right = [(inner, 0), (inner, low + lip_high), (inner - lip, low + lip_high), (inner - lip, low), (half, low), (half, bridge)]
    left = [(-x, y) for x, y in reversed(right)]
    bow = Pos(Z=-wide / 2) * extrude(make_face(Polyline(*right, *left, right[0])), wide)
    up = Rot(X=-90)
    bow += Pos(Y=bridge) * up * Cylinder(boss / 2, boss_high, align=LOW)
    return bow - up * Cylinder(thread / 2, bridge + boss_high, align=LOW)
