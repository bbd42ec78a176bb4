"""A plate with rounded corners and holes in rows and columns

Shows: GridLocations, RectangleRounded, extrude
Dimensions: {"width": 80, "depth": 50, "corner": 6, "thickness": 3, "hole": 2, "pitch": 10, "column_count": 5, "row_count": 3}
"""

from build123d import Circle, GridLocations, RectangleRounded, extrude


def build(part):
    d = part.dimensions
    outline = RectangleRounded(d["width"], d["depth"], d["corner"])
    outline -= [place * Circle(d["hole"]) for place in GridLocations(d["pitch"], d["pitch"], d["column_count"], d["row_count"])]
    shape = extrude(outline, amount=d["thickness"])
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
