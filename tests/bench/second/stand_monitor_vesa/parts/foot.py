from build123d import RectangleRounded, extrude


def foot(wide=280, deep=200, thick=8):
    return extrude(RectangleRounded(wide, deep, 6), -thick)
