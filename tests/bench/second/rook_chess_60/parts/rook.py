from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def rook(high, foot_d=34, foot=8, shaft_d=22, head_d=30, head=16, hollow_d=20, hollow=8, slot=5, cove=2):
    """Shaft with coves towards foot and head; the slots lie between x and y."""
    shaft = Cylinder(shaft_d / 2, high, align=DOWN)
    body = shaft + Pos(0, 0, foot - high) * Cylinder(foot_d / 2, foot, align=DOWN) + Cylinder(head_d / 2, head, align=DOWN)
    body = fillet(_inner(body, shaft_d, high), cove)
    body -= Cylinder(hollow_d / 2, hollow, align=DOWN)
    for turn in (45, 135):
        body -= Rot(Z=turn) * Box(2 * head_d, slot, hollow, align=DOWN)
    return body


def _inner(body, shaft_d, high):
    circles = body.edges().filter_by(lambda e: e.geom_type.name == "CIRCLE" and abs(e.radius - shaft_d / 2) < 1e-3)
    return [e for e in circles.sort_by(Axis.Z) if -high + 1 < e.center().Z < -1]
