import math

from build123d import (
    Align, Box, Cylinder, Line, Pos, Spline, ThreePointArc, extrude, make_face,
)

UP = (Align.CENTER, Align.CENTER, Align.MIN)
SIDE = (Align.MIN, Align.CENTER, Align.MIN)
STEPS = 9


def involute(cosine):
    a = math.acos(min(1.0, cosine))
    return math.degrees(math.tan(a) - a)


def toothed_face(count, pitch, tip, root, base, half_deg, first_deg):
    start = max(root, base)
    at_pitch = involute(base / pitch)

    def half(r):
        return half_deg + at_pitch - involute(base / max(r, base))

    def point(r, deg):
        a = math.radians(deg)
        return (r * math.cos(a), r * math.sin(a))

    radii = [start + (tip - start) * i / (STEPS - 1) for i in range(STEPS)]
    step = 360 / count
    edges = []
    for i in range(count):
        mid = first_deg + i * step
        rising = [point(r, mid - half(r)) for r in radii]
        falling = [point(r, mid + half(r)) for r in reversed(radii)]
        root_in = point(root, mid - half(root))
        root_out = point(root, mid + half(root))
        following = point(root, first_deg + ((i + 1) % count) * step - half(root))
        if base > root:
            edges.append(Line(root_in, rising[0]))
        edges.append(Spline(*rising))
        edges.append(ThreePointArc(rising[-1], point(tip, mid), falling[0]))
        edges.append(Spline(*falling))
        if base > root:
            edges.append(Line(falling[-1], root_out))
        edges.append(ThreePointArc(root_out, point(root, mid + step / 2), following))
    return make_face(edges)


def build(part):
    d = part.dimensions
    low, height = d["hub_height"], d["height"]
    face = toothed_face(
        d["tooth_count"], d["pitch_radius"], d["tip_radius"], d["root_radius"],
        d["base_radius"], d["half_angle_deg"], 0,
    )
    disc = extrude(face, amount=height - low)
    if disc.bounding_box().min.Z < -(height - low) / 2:
        disc = Pos(0, 0, height - low) * disc
    shape = Pos(0, 0, low) * disc
    shape += Cylinder(d["hub_radius"], (low + height) / 2, align=UP)
    r = d["bore_radius"]
    bore = Pos(0, 0, -1) * Cylinder(r, height + 2, align=UP)
    bore -= Pos(d["flat_distance"], 0, -2) * Box(4 * r, 4 * r, height + 4, align=SIDE)
    shape -= bore
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
