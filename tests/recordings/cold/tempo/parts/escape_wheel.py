import math

from build123d import Align, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face

CCM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(r, y0, y1):
    return Pos(0, y0, 0) * Rot(X=-90) * Cylinder(r, y1 - y0, align=CCM)


def prism(points, y0, y1):
    plane = Plane(origin=(0, y1, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    return extrude(plane * make_face(Polyline(*points, close=True)), amount=y1 - y0)


def inv(a):
    return 180 / math.pi * math.tan(math.radians(a)) - a


def gear_points(module, z, addendum, dedendum, first):
    pitch = module * z / 2
    base = pitch * math.cos(math.radians(20))
    tip, root = pitch + addendum, pitch - dedendum

    def half(r):
        a = math.degrees(math.acos(min(1.0, base / max(r, base))))
        return 90 / z + inv(20) - inv(a) - 3 / z

    low = max(base, root)
    steps = 5
    radii = [low + (tip - low) * k / steps for k in range(steps + 1)]
    if root < base:
        radii.insert(0, root)
    points = []
    for i in range(z):
        mid = first + i * 360 / z
        for r in radii:
            t = math.radians(mid - half(r))
            points.append((r * math.cos(t), r * math.sin(t)))
        for r in reversed(radii):
            t = math.radians(mid + half(r))
            points.append((r * math.cos(t), r * math.sin(t)))
    return points


def build(part):
    d = part.dimensions
    wy, wt = d["wheel_y"], d["wheel_thickness"]
    root, tip, n = d["root_radius"], d["tip_radius"], d["escape_count"]
    wide, slim = d["tooth_root_half"], d["tooth_tip_half"]
    wheel = rod(root, wy, wy + wt)
    tooth = [(root - 0.5, -wide), (tip, -slim), (tip, slim), (root - 0.5, wide)]
    for i in range(n):
        t = math.radians(90 + i * 360 / n)
        c, s = math.cos(t), math.sin(t)
        wheel += prism([(u * c - v * s, u * s + v * c) for u, v in tooth], wy, wy + wt)
    pinion = prism(gear_points(d["module"], d["pinion_count"], d["addendum"], d["dedendum"], 0),
                   d["pinion_y"], d["pinion_y"] + d["pinion_length"])
    shape = rod(d["arbor_radius"], d["arbor_front"], d["arbor_end"]) + wheel + pinion
    return shape, {"axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
