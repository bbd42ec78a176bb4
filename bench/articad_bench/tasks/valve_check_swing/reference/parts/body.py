from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, bottom, top, passage = d["length"], d["width"], d["bottom"], d["top"], d["passage"]
    seat, chamber, chamber_width, floor, pin = d["seat"], d["chamber"], d["chamber_width"], d["floor"], d["pin"]
    pin_x, pin_z = d["pin_x"], d["pin_z"]
    shape = Pos(length / 2, 0, bottom) * Box(length, width, top - bottom, align=LOW)
    shape -= Rot(Y=90) * Cylinder(passage / 2, 4 * length)
    shape -= Pos(seat, 0, floor) * Box(chamber, chamber_width, 2 * top, align=(Align.MIN, Align.CENTER, Align.MIN))
    shape -= Pos(pin_x, 0, pin_z) * Rot(X=90) * Cylinder(pin / 2, 2 * width)
    return shape, {
        "flap": {"o": (pin_x, 0, pin_z), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cover": {"o": (length/2, 0, top), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (pin_x, -width/2, pin_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
