def build(part):
    outline = part.sketch("XY", name="Outline")
    part.polygon(
        outline,
        [
            (0, "-length"),
            ("head_radius", "-length"),
            ("head_radius", 0),
            ("spigot_radius", 0),
            ("spigot_radius", "spigot_length"),
            (0, "spigot_length"),
        ],
    )
    part.revolution(outline, "V", name="Turned")
    return part.body, {"seat": part.connector("seat", (0, 0, 0), (0, -1, 0), (1, 0, 0))}
