from math import cos, radians, sin

from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, height, flange, flange_height, bore = d["diameter"], d["height"], d["flange"], d["flange_height"], d["bore"]
    jaw_radius, lean_deg = d["jaw_radius"], d["lean_deg"]
    shape = Cylinder(diameter / 2, height, align=LOW) + Cylinder(flange / 2, flange_height, align=LOW)
    shape -= [Rot(Z=120 * i) * Pos(jaw_radius, 0, height) * Rot(Y=-lean_deg) * Cylinder(bore / 2, 4 * height) for i in range(3)]
    return shape, {
        "sleeve": {"o": (0, 0, flange_height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "jaw_1": {"o": (jaw_radius*cos(radians(0)), jaw_radius*sin(radians(0)), height), "z": (-sin(radians(lean_deg))*cos(radians(0)), -sin(radians(lean_deg))*sin(radians(0)), cos(radians(lean_deg))), "x": (-sin(radians(0)), cos(radians(0)), 0)},
        "jaw_2": {"o": (jaw_radius*cos(radians(120)), jaw_radius*sin(radians(120)), height), "z": (-sin(radians(lean_deg))*cos(radians(120)), -sin(radians(lean_deg))*sin(radians(120)), cos(radians(lean_deg))), "x": (-sin(radians(120)), cos(radians(120)), 0)},
        "jaw_3": {"o": (jaw_radius*cos(radians(240)), jaw_radius*sin(radians(240)), height), "z": (-sin(radians(lean_deg))*cos(radians(240)), -sin(radians(lean_deg))*sin(radians(240)), cos(radians(lean_deg))), "x": (-sin(radians(240)), cos(radians(240)), 0)},
    }
