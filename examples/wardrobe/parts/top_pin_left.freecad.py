def build(part):
    outline = part.sketch("XZ", name="PinSketch")
    part.polygon(
        outline,
        [
            (0, "-length"),
            ("pin_radius", "-length"),
            ("pin_radius", 0),
            ("head_radius", 0),
            ("head_radius", "head_thickness / 2"),
            ("head_radius - head_thickness / 2", "head_thickness"),
            (0, "head_thickness"),
        ],
    )
    part.revolution(outline, name="Pin")
    return part.body, {"head": part.connector("head", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
