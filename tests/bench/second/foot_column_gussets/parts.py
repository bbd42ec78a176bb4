from build123d import Circle, GridLocations, Plane, Polyline, Rectangle, extrude, make_face


def column(side, wall, tall):
    return extrude(Rectangle(side, side) - Rectangle(side - 2 * wall, side - 2 * wall), -tall)


def plate(plate_side, plate_thick, hole=18, square=190):
    return extrude(Rectangle(plate_side, plate_side) - GridLocations(square, square, 2, 2) * Circle(hole / 2), plate_thick)


def gusset(reach, gusset_high, gusset_thick):
    web = make_face(Polyline((0, 0), (-reach, 0), (-reach, gusset_high), close=True))
    return extrude(Plane.XZ * web, gusset_thick / 2, both=True)
