def build(part):
    bevel, half = "0.3 * bar_radius", "(post_x + overhang)"
    outline = part.sketch("XY", (0, "-standoff", 0), name="BarSketch")
    part.polygon(
        outline,
        [
            (f"-{half}", 0),
            (f"-{half}", f"bar_radius - {bevel}"),
            (f"-{half} + {bevel}", "bar_radius"),
            (f"{half} - {bevel}", "bar_radius"),
            (half, f"bar_radius - {bevel}"),
            (half, 0),
        ],
    )
    part.revolution(outline, "H", name="Bar")
    for side, x in (("Left", "-post_x"), ("Right", "post_x")):
        part.cylinder((x, 0, 0), "-Y", "post_radius", "standoff", name=f"{side}Post")
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, -1, 0), (1, 0, 0))}
