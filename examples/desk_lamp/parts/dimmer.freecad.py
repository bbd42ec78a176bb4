def build(part):
    foot, top = "(-bearing - 1.5 * play)", "(play / 2 + height)"  # shoulder for the clip, one play below the bearing
    outline = part.sketch("XZ", name="KnobSketch")
    part.polygon(outline, [(0, "play / 2"), ("radius", "play / 2"), ("radius", f"{top} - 1.5"), ("radius - 1.5", top), (0, top)])
    part.revolution(outline, name="Knob")
    at = ("radius * cos(180 / flute_count)", "radius * sin(180 / flute_count)", "play / 2 - 1")
    flute = part.cylinder(at, "+Z", "flute_radius", "height + 2", cut=True, name="Flute")
    part.polar_pattern([flute], "Z", "flute_count")
    part.box(("radius / 3", "-slot_width / 2", f"{top} - 1"), ("radius", "slot_width", 2), cut=True, name="Pointer")

    part.cylinder((0, 0, "play / 2"), "-Z", "shaft_radius", "bearing + 2 * play", name="Shaft")
    part.cylinder((0, 0, foot), "-Z", "spigot_radius", "spigot_length", name="Spigot")
    return part.body, {
        "shaft": part.connector("shaft", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "clip": part.connector("clip", (0, 0, foot), (0, 0, -1), (1, 0, 0)),
    }
