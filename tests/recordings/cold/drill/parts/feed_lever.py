import math

from build123d import Align, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(radius, start, end):
    return Pos(start, 0, 0) * Rot(Y=90) * Cylinder(radius, end - start, align=UP)


def build(part):
    d = part.dimensions
    half = d["pinion_half"]
    shape = rod(d["shaft_radius"], -d["left_end"], d["journal_start"] + 1)
    shape += rod(d["root_radius"], -half, half)

    inside = (d["shaft_radius"] + d["root_radius"]) / 2
    side = [
        (inside, d["half_base_deg"]),
        (d["base_radius"], d["half_base_deg"]),
        (d["pitch_radius"], d["half_pitch_deg"]),
        (d["mid_radius"], d["half_mid_deg"]),
        (d["tip_radius"], d["half_tip_deg"]),
    ]
    points = []
    count = d["tooth_count"]
    for k in range(count):
        middle = 180 + 360 * k / count
        for r, a in [(r, -a) for r, a in side] + side[::-1]:
            t = math.radians(middle + a)
            points.append((r * math.cos(t), r * math.sin(t)))
    star = extrude(Plane.YZ * make_face(Polyline(*points, close=True)), amount=half, both=True)
    shape += star

    shape += rod(d["journal_radius"], d["journal_start"], d["hub_start"] + 1)
    shape += rod(d["hub_radius"], d["hub_start"], d["hub_end"])
    ax, length = d["arm_x"], d["arm_length"]
    arm = Pos(ax, 0, 0) * Cylinder(d["arm_radius"], length, align=UP)
    connectors = {"shaft": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
    for k in range(3):
        shape += Rot(X=120 * k) * arm
        s, c = -math.sin(math.radians(120 * k)), math.cos(math.radians(120 * k))
        connectors["arm_%d" % (k + 1)] = {"o": (ax, length * s, length * c), "z": (0, s, c), "x": (1, 0, 0)}
    return shape, connectors
