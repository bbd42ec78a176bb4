def build(part):
    sketch = part.sketch("XZ", at=(0, 0, 0))
    part.polygon(sketch, [
        ("hole_radius", 0),
        ("radius", 0),
        ("radius", "length - chamfer"),
        ("radius - chamfer", "length"),
        (0, "length"),
        (0, "hole_depth"),
        ("hole_radius", "hole_depth"),
    ])
    part.revolution(sketch, "V")
    return part.body, {
        "foot": part.connector("foot", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "guide": part.connector("guide", (0, 0, "sleeve_rest"), (0, 0, 1), (1, 0, 0)),
    }
