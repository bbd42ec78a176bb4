def build(part):
    bevel = 0.6
    outline = part.sketch("XY", name="NutSketch")
    part.polygon(
        outline,
        [
            ("hole_radius", 0),
            (f"radius - {bevel}", 0),
            ("radius", bevel),
            ("radius", f"length - {bevel}"),
            (f"radius - {bevel}", "length"),
            (0, "length"),
            (0, "hole_depth"),
            ("hole_radius", "hole_depth"),
        ],
    )
    part.revolution(outline, name="Nut")
    return part.body, {"face": part.connector("face", (0, 0, 0), (0, 1, 0), (1, 0, 0))}
