def build(part):
    inside, deep, half = "width - 2 * board", "depth - back", "(width / 2 - board)"
    part.box(("-width / 2", 0, 0), ("width", "depth", "height"), name="Carcass")
    part.box((f"-{half}", 0, "board"), (inside, deep, "divider_top - 2 * board"), cut=True, name="DrawerRoom")
    part.box((f"-{half}", 0, "divider_top"), (inside, deep, "height - board - divider_top"), cut=True, name="DoorRoom")
    part.box((f"-{half}", "shelf_front", "shelf_z"), (inside, f"{deep} - shelf_front", "board"), name="Shelf")
    part.box(("-stop_width / 2", "stop_y", "height - board - stop_height"), ("stop_width", "board", "stop_height"), name="Stop")

    for level, z in (("Lower", "lower_rail_z"), ("Upper", "upper_rail_z")):
        for side, x in (("Left", f"-{half}"), ("Right", f"{half} - rail_width")):
            corner, size = (x, "rail_front", f"{z} - rail_height / 2"), ("rail_width", f"{deep} - rail_front", "rail_height")
            part.box(corner, size, name=f"{level}{side}Rail")

    hole = "pin_radius + pin_clearance"
    for side, x in (("Left", "-axis_x"), ("Right", "axis_x")):
        part.cylinder((x, "axis_y", "divider_top"), "-Z", hole, "pin_hole_depth", cut=True, name=f"{side}Hole")
        part.cylinder((x, "axis_y", "height"), "-Z", hole, "1.5 * board", cut=True, name=f"{side}TopHole")
    part.cylinder((f"-{half} - rail_seat", "rail_y", "rail_z"), "+X", "rail_radius", f"{inside} + 2 * rail_seat", cut=True, name="RailSeats")

    connectors = {
        "pivot_left": (("-axis_x", "axis_y", "divider_top"), (0, 0, 1), (1, 0, 0)),
        "pivot_right": (("axis_x", "axis_y", "divider_top"), (0, 0, 1), (-1, 0, 0)),
        "top_left": (("-axis_x", "axis_y", "height"), (0, 0, 1), (1, 0, 0)),
        "top_right": (("axis_x", "axis_y", "height"), (0, 0, 1), (-1, 0, 0)),
        "runner_lower": ((0, 0, "slide_low_z"), (0, -1, 0), (1, 0, 0)),
        "runner_upper": ((0, 0, "slide_high_z"), (0, -1, 0), (1, 0, 0)),
        "rail": ((f"-{half} - rail_seat", "rail_y", "rail_z"), (1, 0, 0), (0, 0, 1)),
    }
    for row, y in (("front", "leg_inset"), ("back", "depth - leg_inset")):
        for side, x in (("left", "leg_inset - width / 2"), ("right", "width / 2 - leg_inset")):
            part.cylinder((x, y, 0), "+Z", "leg_hole_radius", "leg_hole_depth", cut=True, name=f"LegHole_{row}_{side}")
            connectors[f"leg_{row}_{side}"] = ((x, y, 0), (0, 0, 1), (1, 0, 0))
    return part.body, {name: part.connector(name, *frame) for name, frame in connectors.items()}
