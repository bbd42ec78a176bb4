from math import cos, radians, sin

from build123d import Cylinder, Plane, Polygon, Rot, extrude


def build(part):
    d = part.dimensions
    inside, outside, depth, span_deg = d["inside"], d["outside"], d["depth"], d["span_deg"]
    ring = Rot(X=90) * (Cylinder(outside, depth) - Cylinder(inside, 2 * depth))
    far, angle = 2 * outside, radians(span_deg)
    wedge = Plane.XZ * Polygon((0, 0), (far, 0), (far * cos(angle), far * sin(angle)), align=None)
    shape = ring & extrude(wedge, depth, both=True)
    return shape, {
        "low": {"o": ((inside+outside)/2, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "high": {"o": ((inside+outside)/2*cos(radians(span_deg)), 0, (inside+outside)/2*sin(radians(span_deg))), "z": (-sin(radians(span_deg)), 0, cos(radians(span_deg))), "x": (cos(radians(span_deg)), 0, sin(radians(span_deg)))},
    }
