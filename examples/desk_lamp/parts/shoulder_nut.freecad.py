def build(part):
    outline = part.sketch("XY", name="NutSketch")
    part.polygon(
        outline,
        [
            ("hole_radius", 0),
            ("radius", 0),
            ("radius", "length - 1.5"),
            ("radius - 1.5", "length"),
            (0, "length"),
            (0, "hole_depth"),
            ("hole_radius", "hole_depth"),
        ],
    )
    part.revolution(outline, name="Nut")
    flute = part.cylinder(("radius", -1, 0), "+Y", "flute_radius", "length + 2", cut=True, name="Flute")
    part.polar_pattern([flute], "Y", "flute_count")
    return part.body, {"face": part.connector("face", (0, 0, 0), (0, 1, 0), (0, 0, 1))}
