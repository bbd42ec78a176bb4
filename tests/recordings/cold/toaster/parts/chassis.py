from build123d import *

BOTTOM = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, depth, gap = d["length"], d["depth"], d["gap"]
    foot, plate, width = d["foot_height"], d["plate"], d["frame_width"]
    top = foot + d["floor_thickness"]
    shape = Pos(0, 0, foot) * extrude(RectangleRounded(length, depth, d["corner"]), amount=d["floor_thickness"])
    for sx in (-1, 1):
        for sy in (-1, 1):
            shape += Pos(sx * d["foot_x"], sy * d["foot_y"], 0) * Cylinder(d["foot_radius"], foot + 1, align=BOTTOM)
    # bulkhead, 1 mm rooted in the floor plate
    bx = d["bulkhead_x"]
    bulkhead = Pos(bx, 0, top - 1) * Box(plate, width, d["bulkhead_top"] - top + 1, align=CORNER)
    for s in (-1, 1):
        bulkhead -= Pos(bx - 1, s * d["arm_slot_y"], d["arm_slot_bottom"]) * Box(
            plate + 2, d["arm_slot_width"], d["bulkhead_top"] - d["arm_slot_bottom"] + 1, align=CORNER)
    # end frame
    fx = d["frame_x"]
    frame = Pos(fx, 0, top - 1) * Box(plate, width, d["frame_top"] - top + 1, align=CORNER)
    frame -= Pos(fx - 1, 0, top - 2) * Box(plate + 2, 2 * d["runner_y"], d["frame_opening_top"] - top + 2, align=CORNER)
    shape += bulkhead
    shape += frame
    for y in (-d["heater_y"], 0, d["heater_y"]):
        shape += Pos(fx, y, d["heater_bottom"]) * Box(
            bx + plate - fx, plate, d["frame_top"] - d["heater_bottom"], align=CORNER)
    for s in (-1, 1):
        shape += Pos(fx, s * (d["runner_y"] + d["runner_width"] / 2), top - 1) * Box(
            bx + 1 - fx, d["runner_width"], d["runner_height"] + 1, align=CORNER)
        shape += Pos(d["rod_x"], s * d["rod_y"], foot) * Cylinder(d["rod_radius"], d["rod_top"] - foot, align=BOTTOM)
    ky, kz, bw = d["knob_y"], d["knob_z"], d["bearing_width"]
    shape += Pos(d["bearing_start"], ky, top - 1) * Box(d["bearing_length"], bw, kz + bw / 2 - top + 1, align=CORNER)
    shape -= Pos(d["bearing_start"] - 1, ky, kz) * Rot(Y=90) * Cylinder(
        d["bore_radius"], d["bearing_length"] + 2, align=BOTTOM)
    return shape, {
        "shell_seat": {"o": (0, -d["seat_y"], top), "z": (0, 0, 1), "x": (1, 0, 0)},
        "lifter_slide": {"o": (d["rod_x"], 0, d["lifter_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "knob_bore": {"o": (length / 2 + gap, ky, kz), "z": (-1, 0, 0), "x": (0, 0, 1)},
        "tray_slide": {"o": (-(length / 2 + gap), 0, top + gap), "z": (-1, 0, 0), "x": (0, 0, 1)},
    }
