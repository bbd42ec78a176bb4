import math

from build123d import Align, Box, Cylinder, Line, Plane, Pos, Rot, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    arm, grip, h = d["arm"], d["grip"], d["half_height"]
    bend = math.radians(d["bend_deg"])
    inner, outer = d["inner_half"], d["half_width"]
    gx, gz = -math.cos(bend), -math.sin(bend)      # along the grip
    ux, uz = -math.sin(bend), math.cos(bend)       # upper normal of the grip
    ex, ez = -arm + grip * gx, grip * gz           # end E
    half = bend / 2
    elbow = (-arm + h * math.tan(half), -h)        # inner corner below C
    outline = make_face([
        Line((0, h), (-arm, h)),
        ThreePointArc((-arm, h), (-arm - h * math.sin(half), h * math.cos(half)), (-arm + h * ux, h * uz)),
        Line((-arm + h * ux, h * uz), (ex + h * ux, ez + h * uz)),
        ThreePointArc((ex + h * ux, ez + h * uz), (ex + h * gx, ez + h * gz), (ex - h * ux, ez - h * uz)),
        Line((ex - h * ux, ez - h * uz), elbow),
        Line(elbow, (0, -h)),
        ThreePointArc((0, -h), (h, 0), (0, h)),
    ])
    body = extrude(Plane.XZ * outline, amount=outer, both=True)
    big = 4 * (arm + grip)
    # the grip's own frame: C at its origin, the grip runs to its -X, its lower side is -Z
    frame = Pos(-arm, 0, 0) * Rot(Y=-d["bend_deg"])
    slot = Box(big, 2 * inner, big)
    slot -= frame * Pos(-d["floor_start"], 0, -(h - d["floor_thickness"])) * Box(
        grip - d["floor_start"], big, big, align=(Align.MAX, Align.CENTER, Align.MAX))
    slot -= frame * Pos(-(grip - d["end_wall"]), 0, 0) * Box(
        big, big, big, align=(Align.MAX, Align.CENTER, Align.CENTER))
    body -= slot
    # stop and pins reach a little into the cheeks
    across = inner + outer
    body += Pos(-(arm + d["stop_far"]), 0, -d["stop_bottom"]) * Box(
        d["stop_far"] - d["stop_near"], across, d["stop_bottom"] - d["stop_top"],
        align=(Align.MIN, Align.CENTER, Align.MIN))
    body += Rot(X=90) * Cylinder(d["pin_radius"], across)
    body += Pos(-arm, 0, 0) * Rot(X=90) * Cylinder(d["pin_radius"], across)
    return body, {
        "jaw_pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "link_pivot": {"o": (-arm, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
