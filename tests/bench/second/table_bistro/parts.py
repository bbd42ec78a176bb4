from build123d import Align, Box, Circle, Cylinder, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def foot(foot_thick, across=400):
    """Its upper face is z = 0."""
    return Cylinder(across / 2, foot_thick, align=DOWN)


def column(column_d, column_wall, column_long):
    return extrude(Circle(column_d / 2) - Circle(column_d / 2 - column_wall), column_long)


def plate(plate_side, plate_thick):
    return Box(plate_side, plate_side, plate_thick, align=UP)


def top(board, across=600):
    return Cylinder(across / 2, board, align=DOWN)
