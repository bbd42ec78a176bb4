def build(part):
    outline = part.sketch("XZ", name="LegSketch")
    part.polygon(
        outline,
        [
            (0, "-height"),
            ("bottom_radius", "-height"),
            ("top_radius", 0),
            ("spigot_radius", 0),
            ("spigot_radius", "spigot_length"),
            (0, "spigot_length"),
        ],
    )
    part.revolution(outline, name="Leg")
    return part.body, {"top": part.connector("top", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
