def build(part):
    bevel = "0.4 * height"
    outline = part.sketch("XZ", name="BaseSketch")
    part.polygon(
        outline,
        [
            (0, 0),
            ("radius", 0),
            ("radius", f"height - {bevel}"),
            (f"radius - {bevel}", "height"),
            ("hub_radius", "height"),
            ("hub_radius", "hub_height - 2"),
            ("hub_radius - 2", "hub_height"),
            (0, "hub_height"),
        ],
    )
    part.revolution(outline, name="Base")
    for name, x, shaft, recess in (("Column", 0, "column_radius", "column_recess_radius"), ("Knob", "knob_x", "knob_radius", "knob_recess_radius")):
        part.cylinder((x, 0, -1), "+Z", f"{shaft} + clearance", "hub_height + 2", cut=True, name=f"{name}Bore")
        part.cylinder((x, 0, 0), "+Z", recess, "recess", cut=True, name=f"{name}Recess")
    return part.body, {
        "column": part.connector("column", (0, 0, "hub_height + play / 2"), (0, 0, 1), (1, 0, 0)),
        "dimmer": part.connector("dimmer", ("knob_x", 0, "height + play / 2"), (0, 0, 1), (1, 0, 0)),
    }
