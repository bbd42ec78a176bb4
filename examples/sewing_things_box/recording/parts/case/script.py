def build(part):
    part.box(("-width / 2", 0, 0), ("width", "depth", "height"), name="Block")
    part.box(
        ("-width / 2 + wall", -1, "wall"), ("width - 2 * wall", "depth - wall + 1", "bay_top - wall"), cut=True, name="Bay"
    )
    part.box(
        ("-width / 2 + wall", "wall", "shelf_top"),
        ("width - 2 * wall", "depth - 2 * wall", "height - shelf_top + 1"),
        cut=True,
        name="Compartment",
    )
    for side, start in (("Right", "knuckle_inner"), ("Left", "-knuckle_outer")):
        part.box(
            (start, "depth", "height - knuckle_radius"),
            ("knuckle_outer - knuckle_inner", "axis_y - depth", "knuckle_radius"),
            name=f"{side}Bar",
        )
        part.cylinder(
            (start, "axis_y", "height"), "+X", "knuckle_radius", "knuckle_outer - knuckle_inner", name=f"{side}Knuckle"
        )
    part.cylinder(
        ("-knuckle_outer - 1", "axis_y", "height"), "+X", "pin_radius", "2 * knuckle_outer + 2", cut=True, name="PinBore"
    )
    return part.body, {
        "pin": part.connector("pin", (0, "axis_y", "height"), (-1, 0, 0), (0, 1, 0)),
        "runner": part.connector("runner", (0, 0, "runner_z"), (0, -1, 0), (1, 0, 0)),
    }
