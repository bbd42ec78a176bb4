from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
MIN_Y = (Align.CENTER, Align.MIN, Align.MIN)
Y = Rot(X=-90)  # turns z to y


def rod(across, y, long):
    return Pos(0, y, 0) * Y * Cylinder(across / 2, long, align=UP)


def block(foot, deep, foot_high, round_d, centre_z, bore_d, foot_pitch, oil_hole_y, bolt_d=11, sink_d=18, sink=6, oil_d=6):
    body = Box(foot, deep, foot_high, align=UP) + Box(round_d, deep, centre_z, align=UP) + Pos(Z=centre_z) * rod(round_d, -deep / 2, deep)
    body -= Pos(Z=centre_z) * rod(bore_d, -deep, 2 * deep)
    for x in (-foot_pitch / 2, foot_pitch / 2):
        body -= Pos(x, 0, 0) * (Cylinder(bolt_d / 2, 3 * foot_high) + Pos(Z=foot_high - sink) * Cylinder(sink_d / 2, sink, align=UP))
    return body - Pos(0, oil_hole_y, centre_z) * Cylinder(oil_d / 2, round_d, align=UP)


def shaft(shoulder_start, shoulder_length, nose, journal, journal_d, end, end_d, keyway_width, keyway_depth, keyway_start, key_long, key_y, nose_d=20, shoulder_d=40):
    body = rod(journal_d, -shoulder_start, journal) + rod(shoulder_d, -shoulder_start - shoulder_length, shoulder_length)
    body += rod(nose_d, -shoulder_start - shoulder_length - nose, nose + 1) + rod(end_d, journal - shoulder_start - 1, end + 1)
    return body - Pos(0, key_y, end_d / 2 - keyway_depth) * Box(keyway_width, key_long, end_d, align=MIN_Y)


def key(keyway_width, key_long, key_high):
    return Box(keyway_width, key_long, key_high, align=MIN_Y)


def ring(journal_d, ring, ring_d, hole_d=5):
    body = rod(ring_d, 0, ring) - rod(journal_d, -ring, 3 * ring)
    return body - Pos(0, ring / 2, 0) * Cylinder(hole_d / 2, ring_d, align=UP)
