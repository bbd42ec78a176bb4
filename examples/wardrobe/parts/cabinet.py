from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)  # centred in x, from y = 0 backwards and z = 0 upwards
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, height, depth, board = d["width"], d["height"], d["depth"], d["board"]
    inside, deep = width - 2 * board, depth - d["back"]

    body = Box(width, depth, height, align=FRONT)
    body -= Pos(0, 0, board) * Box(inside, deep, d["divider_top"] - 2 * board, align=FRONT)
    body -= Pos(0, 0, d["divider_top"]) * Box(inside, deep, height - board - d["divider_top"], align=FRONT)
    body += Pos(0, d["shelf_front"], d["shelf_z"]) * Box(inside, deep - d["shelf_front"], board, align=FRONT)
    body += Pos(0, d["stop_y"], height - board - d["stop_height"]) * Box(d["stop_width"], board, d["stop_height"], align=FRONT)

    rail = Box(d["rail_width"], deep - d["rail_front"], d["rail_height"], align=(Align.CENTER, Align.MIN, Align.CENTER))
    for z in (d["lower_rail_z"], d["upper_rail_z"]):
        for side in (-1, 1):
            body += Pos(side * (inside - d["rail_width"]) / 2, d["rail_front"], z) * rail

    pin_hole = d["pin_radius"] + d["pin_clearance"]
    for x in (-d["axis_x"], d["axis_x"]):
        body -= Pos(x, d["axis_y"], d["divider_top"]) * Cylinder(pin_hole, d["pin_hole_depth"], align=HIGH)
        body -= Pos(x, d["axis_y"], height) * Cylinder(pin_hole, 3 * board)
    body -= Pos(0, d["rail_y"], d["rail_z"]) * Rot(Y=90) * Cylinder(d["rail_radius"], inside + 2 * d["rail_seat"])

    connectors = {
        "pivot_left": {"o": (-d["axis_x"], d["axis_y"], d["divider_top"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pivot_right": {"o": (d["axis_x"], d["axis_y"], d["divider_top"]), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "top_left": {"o": (-d["axis_x"], d["axis_y"], height), "z": (0, 0, 1), "x": (1, 0, 0)},
        "top_right": {"o": (d["axis_x"], d["axis_y"], height), "z": (0, 0, 1), "x": (-1, 0, 0)},
        "runner_lower": {"o": (0, 0, d["slide_low_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "runner_upper": {"o": (0, 0, d["slide_high_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "rail": {"o": (-inside / 2 - d["rail_seat"], d["rail_y"], d["rail_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
    leg_x = width / 2 - d["leg_inset"]
    for row, y in (("front", d["leg_inset"]), ("back", depth - d["leg_inset"])):
        for side, x in (("left", -leg_x), ("right", leg_x)):
            body -= Pos(x, y, 0) * Cylinder(d["leg_hole_radius"], d["leg_hole_depth"], align=LOW)
            connectors[f"leg_{row}_{side}"] = {"o": (x, y, 0), "z": (0, 0, 1), "x": (1, 0, 0)}
    return body, connectors
