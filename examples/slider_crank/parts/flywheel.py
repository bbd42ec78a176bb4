from math import cos, pi, sin

from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, width, rim = d["radius"], d["width"], d["radius"] - d["rim_width"]
    wheel = Cylinder(radius, width, align=LOW)
    wheel -= Pos(0, 0, d["web_width"]) * (Cylinder(rim, width, align=LOW) - Cylinder(d["hub_radius"], width, align=LOW))
    middle = (rim + d["hub_radius"]) / 2
    for i in range(d["hole_count"]):
        angle = 2 * pi * i / d["hole_count"]
        wheel -= Pos(middle * cos(angle), middle * sin(angle), 0) * Cylinder(d["hole_radius"], 4 * width)
    wheel -= Cylinder(d["seat_radius"], d["seat_depth"], align=LOW)
    return Rot(X=-90) * wheel, {"face": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)}}
