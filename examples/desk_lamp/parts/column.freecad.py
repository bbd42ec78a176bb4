def build(part):
    foot = "(-bearing - 1.5 * play)"  # shoulder for the ring, one play below the bearing
    outline = part.sketch("XZ", name="ShaftSketch")
    part.polygon(
        outline,
        [
            (0, f"{foot} - spigot_length"),
            ("spigot_radius", f"{foot} - spigot_length"),
            ("spigot_radius", foot),
            ("shaft_radius", foot),
            ("shaft_radius", "play / 2"),
            ("collar_radius", "play / 2"),
            ("collar_radius", "play / 2 + collar_height"),
            ("tube_radius", "play / 2 + collar_height"),
            ("tube_radius", "axis_z - neck_height"),
            (0, "axis_z - neck_height"),
        ],
    )
    part.revolution(outline, name="Shaft")

    part.box(("-tongue_width / 2", "-tongue / 2", "axis_z - neck_height"), ("tongue_width", "tongue", "neck_height"), name="Neck")
    start = (0, "-tongue / 2", "axis_z")
    part.cylinder(start, "+Y", "tongue_width / 2", "tongue", name="Tongue")
    part.cylinder(start, "+Y", "pin_radius", "tongue + pin_length", name="Pin")
    part.cylinder(start, "+Y", "pin_spigot_radius", "tongue + pin_length + pin_spigot_length", name="PinSpigot")
    return part.body, {
        "shaft": part.connector("shaft", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "ring": part.connector("ring", (0, 0, foot), (0, 0, -1), (1, 0, 0)),
        "shoulder": part.connector("shoulder", (0, "tongue / 2 + play / 2", "axis_z"), (0, -1, 0), (1, 0, 0)),
        "nut": part.connector("nut", (0, "tongue / 2 + pin_length", "axis_z"), (0, 1, 0), (0, 0, 1)),
    }
