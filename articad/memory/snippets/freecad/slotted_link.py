"""A link plate with a long hole in which a pin slides

Shows: part.slot, part.pad
Dimensions: {"length": 80, "width": 16, "thickness": 4, "travel": 30, "pin": 3}
"""


def build(part):
    outline = part.sketch("XY")
    part.slot(outline, ("-(length - width) / 2", 0), ("(length - width) / 2", 0), "width / 2")
    part.slot(outline, ("-travel / 2", 0), ("travel / 2", 0), "pin")
    part.pad(outline, "thickness")
    return part.body, {"mount": part.connector("mount", ("-travel / 2", 0, 0), (0, 0, 1), (1, 0, 0))}
