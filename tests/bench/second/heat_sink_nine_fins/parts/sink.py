from build123d import Align, Cylinder, GridLocations, Plane, Pos, Rectangle, extrude

LOW = (Align.CENTER, Align.MIN)


def sink(wide, long, high=35, base=5, fin=1.5, fins_count=9, hole=4.2, apart=80):
    """A profile of a plate and its fins; both holes are in the channel right of the middle fin."""
    pitch = (wide - fin) / (fins_count - 1)
    profile = Rectangle(wide, base, align=LOW) + GridLocations(pitch, 1, fins_count, 1) * Rectangle(fin, high, align=LOW)
    body = extrude(Plane.XZ * profile, long / 2, both=True)
    for y in (-apart / 2, apart / 2):
        body -= Pos(pitch / 2, y, 0) * Cylinder(hole / 2, 3 * base)
    return body
