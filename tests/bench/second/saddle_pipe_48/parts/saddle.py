from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rectangle, extrude

LOW = (Align.CENTER, Align.MIN)


def saddle(thick, inside, high, long=115, wide=30, hole=9, apart=85):
    """The strip's section in x and z, drawn as the outside less the inside."""
    outside = inside + thick
    down = high - outside  # of the feet's lower face below the axis
    solid = Circle(outside) + Pos(0, -down) * Rectangle(2 * outside, down, align=LOW) + Pos(0, -down) * Rectangle(long, thick, align=LOW)
    solid -= Pos(0, -down) * Rectangle(2 * outside, 4 * high, align=(Align.CENTER, Align.MAX))
    solid -= Circle(inside) + Pos(0, -down) * Rectangle(2 * inside, down, align=LOW)
    strip = extrude(Plane.XZ * solid, wide / 2, both=True)
    for x in (-apart / 2, apart / 2):
        strip -= Pos(x, 0, -down) * Cylinder(hole / 2, 3 * thick)
    return strip
