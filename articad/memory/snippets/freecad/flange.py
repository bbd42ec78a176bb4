"""A flange with a bore and equal holes on a bolt circle

Shows: part.polar_pattern, PartDesign::PolarPattern, part.cylinder
Dimensions: {"radius": 40, "thickness": 8, "bore": 12, "circle": 28, "hole": 3, "hole_count": 6}
"""


def build(part):
    part.cylinder((0, 0, 0), "+Z", "radius", "thickness", name="Disc")
    part.cylinder((0, 0, -1), "+Z", "bore", "thickness + 2", cut=True, name="Bore")
    hole = part.cylinder(("circle", 0, -1), "+Z", "hole", "thickness + 2", cut=True, name="Hole")
    part.polar_pattern([hole], "Z", "hole_count")
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
