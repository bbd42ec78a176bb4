"""A transition from a large square below to a small one above

Shows: part.loft, PartDesign::AdditiveLoft, part.sketch
Dimensions: {"side": 40, "top": 16, "height": 30}
"""


def build(part):
    below = part.sketch("XY")
    part.rectangle(below, "-side / 2", "-side / 2", "side", "side")
    above = part.sketch("XY", at=(0, 0, "height"))
    part.rectangle(above, "-top / 2", "-top / 2", "top", "top")
    part.loft(below, above)
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
