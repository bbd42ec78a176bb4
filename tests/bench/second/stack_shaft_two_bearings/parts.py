from build123d import Align, Axis, Cylinder, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def bush(inner, outer, long):
    return Cylinder(outer / 2, long, align=UP) - Cylinder(inner / 2, 3 * long)


def bearing(shaft, ring_across, bearing):
    return bush(shaft, ring_across, bearing)


def spacer(shaft, across, spacer):
    return bush(shaft, across, spacer)


def clip(shaft, clip_across, clip):
    return bush(shaft, clip_across, clip)


def shaft(shaft, groove, clip, shoulder, shoulder_long, end):
    body = Cylinder(shaft / 2, groove + clip + end, align=UP)
    body = chamfer(body.edges().sort_by(Axis.Z)[-1], 1)
    return body + Cylinder(shoulder / 2, shoulder_long, align=(Align.CENTER, Align.CENTER, Align.MAX))
