from math import cos, radians, sin

from build123d import Box, Circle, Cylinder, Plane, Pos, Rot, extrude, make_hull


def build(part):
    d = part.dimensions
    inside, plate, eye, reach = d["fork_y"], d["plate"], d["eye"], d["reach"]
    angle, outside = radians(d["lever_angle_deg"]), inside + plate
    link = (d["lever"] * cos(angle), d["lever"] * sin(angle))

    ends = [Pos(0, 0), Pos(*link), Pos(d["bridge"], 0)]
    outline = make_hull([edge for place in ends for edge in (place * Circle(eye)).edges()])
    arm = extrude(Plane.XZ.offset(inside) * outline, plate) + extrude(Plane.XZ.offset(-outside) * outline, plate)
    arm += Pos((d["bridge"] + reach) / 2, 0, 0) * Box(reach - d["bridge"], 2 * outside, d["bar_height"])
    arm += Pos(reach, 0, 0) * Cylinder(d["boss_radius"], d["boss_height"])
    arm -= Pos(reach, 0, 0) * Cylinder(d["bore_radius"], 2 * d["boss_height"])

    arm += Pos(link[0], 0, link[1]) * Rot(X=90) * Cylinder(d["pin_radius"], 2 * outside)
    for side in (-1, 1):
        arm += Pos(0, side * (outside + d["stub"] / 2 - plate / 2), 0) * Rot(X=90) * Cylinder(d["pivot_radius"], d["stub"] + plate)
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return arm, {
        "pivot": {"o": (0, 0, 0), **axis},
        "link": {"o": (link[0], 0, link[1]), **axis},
        "thread": {"o": (reach, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
