import math

from build123d import Align, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face

CCM = (Align.CENTER, Align.CENTER, Align.MIN)


def rod(r, y0, y1):
    return Pos(0, y0, 0) * Rot(X=-90) * Cylinder(r, y1 - y0, align=CCM)


def prism(points, y0, y1):
    plane = Plane(origin=(0, y1, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    return extrude(plane * make_face(Polyline(*points, close=True)), amount=y1 - y0)


def build(part):
    d = part.dimensions
    y0 = d["anchor_y"]
    y1 = y0 + d["anchor_thickness"]
    h = d["arm_half"]
    shape = rod(d["arbor_radius"], d["arbor_front"], d["arbor_end"]) + rod(d["boss_radius"], y0, y1)
    for side in (-1, 1):
        px, pz = side * d["pin_x"], -d["pin_drop"]
        length = math.hypot(px, pz)
        c, s = px / length, pz / length
        bar = [(0, -h), (length, -h), (length, h), (0, h)]
        shape += prism([(u * c - v * s, u * s + v * c) for u, v in bar], y0, y1)
        shape += Pos(px, 0, pz) * rod(h, y0, y1)
        shape += Pos(px, 0, pz) * rod(d["pin_radius"], d["pin_front"], y1)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "pendulum": {"o": (0, d["pendulum_y"], 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
