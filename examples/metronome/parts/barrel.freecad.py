def build(part):
    rim = "radius + rim_height"
    outline = part.sketch("XY", name="DrumSketch")
    part.polygon(
        outline,
        [
            ("-hole_depth", 0),
            ("-hole_depth", "hole_radius"),
            (0, "hole_radius"),
            (0, rim),
            ("-rim_width", rim),
            ("-rim_width", "radius"),
            ("rim_width - width", "radius"),
            ("rim_width - width", rim),
            ("-width", rim),
            ("-width", 0),
        ],
    )
    part.revolution(outline, "H", name="Drum")
    return part.body, {"face": part.connector("face", (0, 0, 0), (-1, 0, 0), (0, 0, 1))}
