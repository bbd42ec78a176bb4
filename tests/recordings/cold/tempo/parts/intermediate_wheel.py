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
    m, zw, zp = d["module"], d["teeth_count"], d["pinion_count"]
    wy, wt = d["wheel_y"], d["wheel_thickness"]
    wheel = prism(gear_points(m, zw, d["wheel_addendum"], d["dedendum"], 180 / zw), wy, wy + wt)
    for i in range(d["hole_count"]):
        t = math.radians(i * 360 / d["hole_count"])
        c = d["hole_circle"]
        wheel -= Pos(c * math.cos(t), 0, c * math.sin(t)) * rod(d["hole_radius"], wy - 1, wy + wt + 1)
    pinion = prism(gear_points(m, zp, d["pinion_addendum"], d["dedendum"], 0), d["pinion_y"], d["pinion_y"] + d["pinion_length"])
    shape = rod(d["arbor_radius"], d["arbor_front"], d["arbor_end"]) + wheel + pinion
    return shape, {"axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
