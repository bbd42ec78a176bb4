def build(part):
    outline = part.sketch("XZ", (0, "play / 2", 0), name="BarSketch")
    part.slot(outline, (0, 0), ("length", 0), "width / 2")
    part.slot(outline, ("1.5 * width", 0), ("length - 1.5 * width", 0), "slot_width / 2")
    part.pad(outline, "thickness", back=True, name="Bar")
    part.cylinder((0, 0, 0), "+Y", "pin_radius + clearance", "play / 2 + thickness + 1", cut=True, name="Bore")

    elbow, reach = ("length", "play / 2 + thickness / 2", 0), "thickness / 2 + pin_length"
    part.cylinder(elbow, "-Y", "pin_radius", reach, name="Pin")
    part.cylinder(elbow, "-Y", "spigot_radius", f"{reach} + spigot_length", name="Spigot")
    return part.body, {
        "shoulder": part.connector("shoulder", (0, 0, 0), (0, -1, 0), (1, 0, 0)),
        "elbow": part.connector("elbow", ("length", 0, 0), (0, -1, 0), (1, 0, 0)),
        "nut": part.connector("nut", ("length", "play / 2 - pin_length", 0), (0, -1, 0)),
    }
