from math import cos, radians, sin

from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    inside, plate, eye = d["fork_y"], d["plate"], d["eye"]
    angle, outside, bridge = radians(d["grip_angle_deg"]), inside + plate, d["bridge"]
    along = (cos(angle), 0, sin(angle))

    ends = [Pos(0, 0), Pos(d["throw"], 0), Pos(bridge * along[0], bridge * along[2])]
    outline = make_hull([edge for place in ends for edge in (place * Circle(eye)).edges()])
    handle = extrude(Plane.XZ.offset(inside) * outline, plate) + extrude(Plane.XZ.offset(-outside) * outline, plate)

    shank = Plane((0, 0, 0), x_dir=(0, 1, 0), z_dir=along)
    handle += shank * Pos(0, 0, bridge) * Box(2 * outside, 1.6 * eye, 1.6 * eye)
    handle += shank * Pos(0, 0, bridge) * Cylinder(d["shank_radius"], d["shank_end"] - bridge, align=LOW)
    handle += Pos(d["throw"], 0, 0) * Rot(X=90) * Cylinder(d["pin_radius"], 2 * outside)
    for side in (-1, 1):
        handle += Pos(0, side * (outside + d["stub"] / 2 - plate / 2), 0) * Rot(X=90) * Cylinder(d["pivot_radius"], d["stub"] + plate)
    end = tuple(d["shank_end"] * c for c in along)
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return handle, {
        "pivot": {"o": (0, 0, 0), **axis},
        "link": {"o": (d["throw"], 0, 0), **axis},
        "grip": {"o": end, "z": along, "x": (0, 1, 0)},
    }
