from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    wall, axis = d["wall"], (d["axis_x"], d["axis_y"], 0)
    bottom, top, low = d["cylinder_bottom"], d["cylinder_top"], d["base_bottom"]
    outer = d["bore"] + d["cylinder_wall"]

    foot, neck = d["base_width"] / 2 - 10, outer - 4
    outline = Polygon((-foot, low), (foot, low), (neck, bottom - 10), (neck, top), (-neck, top), (-neck, bottom - 10), align=None)
    frame = extrude(Plane.XZ * outline, -wall)  # Plane.XZ looks along -Y
    frame += Pos(0, d["axis_y"] + wall, low) * Box(d["base_width"], d["base_depth"], d["base_height"], align=LOW)

    frame += Pos(*axis) * Pos(0, 0, bottom) * Cylinder(outer, top - bottom, align=LOW)
    pitch = (top - bottom) / (d["fin_count"] + 0.5)
    for i in range(d["fin_count"]):
        frame += Pos(*axis) * Pos(0, 0, bottom + (i + 0.5) * pitch) * Cylinder(outer + d["fin_width"], 0.4 * pitch, align=LOW)

    frame -= Pos(*axis) * Pos(0, 0, d["relief_bottom"]) * Cylinder(d["bore"] + d["clearance"], top, align=LOW)
    corner = (Align.MIN, Align.MAX, Align.MIN)
    frame -= Pos(*axis) * Pos(8, -5, bottom - 1) * Box(3 * outer, 3 * outer, d["window_height"] + 1, align=corner)
    frame -= Rot(X=90) * Cylinder(d["shaft_radius"] + d["clearance"], 4 * wall)
    return frame, {
        "crank": {"o": (0, -d["play"] / 2, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
        "cylinder": {"o": axis, "z": (0, 0, 1), "x": (1, 0, 0)},
        "head": {"o": (axis[0], axis[1], top), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
