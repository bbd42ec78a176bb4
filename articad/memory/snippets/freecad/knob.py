"""A lathe-turned knob: an outline revolved about an axis

Shows: part.revolution, PartDesign::Revolution, part.polygon
Dimensions: {"foot": 6, "neck": 4, "head": 12, "low": 8, "height": 20}
"""


def build(part):
    outline = part.sketch("XZ")
    corners = [(0, 0), ("foot", 0), ("neck", "low"), ("head", "low + 4"), ("head", "height"), (0, "height")]
    part.polygon(outline, corners)
    part.revolution(outline, "V")
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
