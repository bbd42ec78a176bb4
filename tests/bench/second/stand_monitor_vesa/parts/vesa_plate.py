from build123d import BuildSketch, Circle, GridLocations, Mode, Plane, RectangleRounded, extrude


def vesa_plate(vesa, side=120, thick=4, hole=4.5):
    with BuildSketch(Plane.XZ) as plate:
        RectangleRounded(side, side, 5)
        with GridLocations(vesa, vesa, 2, 2):
            Circle(hole / 2, mode=Mode.SUBTRACT)
    return extrude(plate.sketch, thick)
