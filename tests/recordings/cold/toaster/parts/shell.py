from build123d import *

BOTTOM = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, depth, height, wall = d["length"], d["depth"], d["height"], d["wall"]
    outer = extrude(RectangleRounded(length, depth, d["corner"]), amount=height)
    outer = fillet(outer.faces().sort_by(Axis.Z)[-1].edges(), radius=d["top_round"])
    inner = extrude(RectangleRounded(length - 2 * wall, depth - 2 * wall, d["corner"] - wall), amount=height - wall + 1)
    shape = outer - Pos(0, 0, -1) * inner
    for s in (-1, 1):
        shape -= Pos(d["slot_x"], s * d["slot_y"], height - wall - 1) * Box(
            d["slot_length"], d["slot_width"], wall + 2, align=BOTTOM)
    right = length / 2 - wall / 2
    shape -= Pos(right, 0, d["lever_slot_bottom"]) * Box(
        wall + 2, d["lever_slot_width"], d["lever_slot_top"] - d["lever_slot_bottom"], align=BOTTOM)
    shape -= Pos(right, d["knob_y"], d["knob_hole_z"]) * Rot(Y=90) * Cylinder(d["knob_hole_radius"], wall + 2)
    shape -= Pos(-right, 0, -1) * Box(
        wall + 2, d["tray_opening_width"], d["tray_opening_height"] + 1, align=BOTTOM)
    return shape, {"seat": {"o": (0, -(depth / 2 - wall / 2), 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
