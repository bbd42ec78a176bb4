from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    barrel, barrel_length, collar, collar_height, hole = d["barrel"], d["barrel_length"], d["collar"], d["collar_height"], d["hole"]
    chamber, chamber_low, chamber_high = d["chamber"], d["chamber_low"], d["chamber_high"]
    shape = Cylinder(barrel / 2, barrel_length, align=LOW) + Pos(0, 0, barrel_length) * Cylinder(collar / 2, collar_height, align=LOW)
    shape -= Cylinder(hole / 2, 4 * barrel_length)
    shape -= Pos(0, 0, chamber_low) * Cylinder(chamber / 2, chamber_high - chamber_low, align=LOW)
    return shape, {"pin": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
