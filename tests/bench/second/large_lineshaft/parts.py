"""Parts of the line shaft; what turns, and what holds a bearing, is drawn about its axis, x."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_x(diameter, long):
    return Rot(0, 90, 0) * Cylinder(diameter / 2, long)


def bench(bench_long, bench_deep, bench_thick):
    return Box(bench_long, bench_deep, bench_thick, align=UP)


def leg(leg, bench_high, bench_thick):
    return Box(leg, leg, bench_high - bench_thick, align=UP)


def post(post, post_high):
    return Box(post, post, post_high, align=UP)


def beam(bench_long, post, beam_high):
    return Box(bench_long, post, beam_high, align=UP)


def hanger(drop, post, ring_d, ring_wide, plate=20, rim=15, arm=70):
    body = Pos(0, 0, drop) * Box(90, post, plate, align=DOWN) + Box(ring_wide, arm, drop - plate / 2, align=UP)
    body += along_x(ring_d + 2 * rim, ring_wide)
    return body - along_x(ring_d, 2 * ring_wide)


def ring(ring_d, ring_wide, shaft_d, play):
    return along_x(ring_d, ring_wide) - along_x(shaft_d + play, 2 * ring_wide)


def shaft(shaft_d, shaft_long, pitch, key_long, key_wide, key_in):
    body = along_x(shaft_d, shaft_long)
    for i in range(5):
        body -= Pos((i - 2) * pitch, 0, shaft_d / 2 - key_in) * Box(key_long, key_wide, 2 * key_in, align=UP)
    return body


def key(key_long, key_wide, key_high):
    return Box(key_long, key_wide, key_high, align=UP)


def collar(collar_d, collar_wide, shaft_d):
    return along_x(collar_d, collar_wide) - along_x(shaft_d, 2 * collar_wide)


def wheel(diameter, face, bore, hub, rim=8, web=12):
    """Rim and hub of the same width, with a pierced web between them."""
    inner = diameter - 2 * rim
    body = along_x(diameter, face) - (along_x(inner, 2 * face) - along_x(hub, 2 * face))
    body += along_x(inner + 2, web)
    hole = 0.3 * (inner - hub)
    for i in range(5):
        body -= Rot(72 * i + 36, 0, 0) * Pos(0, 0, (inner + hub) / 4) * along_x(hole, 2 * face)
    return body - along_x(bore, 2 * face)


def pulley(diameter, face, shaft_d, key_wide, key_high, key_in, hub=72):
    body = wheel(diameter, face, shaft_d, hub)
    return body - Box(2 * face, key_wide, shaft_d / 2 - key_in + key_high, align=UP)


def driven(driven_d, face, counter_d, hub=56):
    return wheel(driven_d, face, counter_d, hub)


def work(work_d, work_face, counter_d, hub=52):
    return wheel(work_d, work_face, counter_d, hub)


def counter(counter_d, counter_long, counter_off):
    """Its middle lies counter_off toward +x from the driven pulley's."""
    return Pos(counter_off, 0, 0) * along_x(counter_d, counter_long)


def pedestal(counter_up, race_d, wide=20, rim=14, foot=160, foot_high=22, arm=66):
    body = Pos(0, 0, -counter_up) * (Box(50, foot, foot_high, align=UP) + Box(wide, arm, counter_up, align=UP))
    body += along_x(race_d + 2 * rim, wide)
    return body - along_x(race_d, 2 * wide)


def race(race_d, race_wide, counter_d, play):
    return along_x(race_d, race_wide) - along_x(counter_d + play, 2 * race_wide)
