from math import cos, radians, sin

from build123d import Align, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, Sphere, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thick, face = d["length"], d["width"], d["thickness"], d["play"] / 2
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, width)
    outline -= Pos(length / 2, 0) * SlotCenterToCenter(length - 3 * width, d["slot_width"])
    bar = extrude(Plane.XZ.offset(face) * outline, thick)  # Plane.XZ looks along -Y
    bar -= Rot(X=90) * Cylinder(d["pin_radius"] + d["clearance"], 4 * thick)

    angle, reach, middle = radians(d["stud_angle_deg"]), d["stud_reach"], -face - thick / 2
    direction = (cos(angle), 0, sin(angle))
    ball = (length + reach * direction[0], middle, reach * direction[2])
    bar += Plane((length, middle, 0), z_dir=direction) * Cylinder(d["neck_radius"], reach, align=LOW)
    bar += Pos(*ball) * Sphere(d["ball_radius"])
    return bar, {
        "elbow": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "ball": {"o": ball, "z": direction, "x": (0, 1, 0)},
    }
