from build123d import Circle, PolarLocations, Pos, extrude


def flange(thick, raised, across=165, face=102, bore=61, hole=18, circle=125, holes_count=4):
    """Two layers: the raised face from z = 0, then the disc."""
    disc = Circle(across / 2) - Circle(bore / 2) - PolarLocations(circle / 2, holes_count, start_angle=45) * Circle(hole / 2)
    return extrude(Circle(face / 2) - Circle(bore / 2), raised) + Pos(0, 0, raised) * extrude(disc, thick)
