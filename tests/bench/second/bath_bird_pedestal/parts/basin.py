from build123d import Align, Axis, Cylinder, fillet

DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def basin(basin_high, across=420, wall=30, rounded=12):
    """A round trough below z = 0; the floor is as thick as the wall, and the corner between them is rounded."""
    water = Cylinder(across / 2 - wall, basin_high - wall, align=DOWN)
    water = fillet(water.edges().group_by(Axis.Z)[0], rounded)
    return Cylinder(across / 2, basin_high, align=DOWN) - water
