from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    journal_diameter, journal_length, shoulder_diameter, shoulder_length, shoulder_start, stub_diameter = d["journal_diameter"], d["journal_length"], d["shoulder_diameter"], d["shoulder_length"], d["shoulder_start"], d["stub_diameter"]
    stub_length, seat_diameter, seat_length, keyway_width, keyway_length, keyway_depth = d["stub_length"], d["seat_diameter"], d["seat_length"], d["keyway_width"], d["keyway_length"], d["keyway_depth"]
    keyway_start = d["keyway_start"]
    turned = Rot(X=-90)
    end = journal_length - shoulder_start
    shape = Pos(0, -shoulder_start, 0) * turned * Cylinder(journal_diameter / 2, journal_length, align=LOW)
    shape += Pos(0, -shoulder_start, 0) * turned * Cylinder(shoulder_diameter / 2, shoulder_length, align=HIGH)
    shape += Pos(0, -shoulder_start - shoulder_length, 0) * turned * Cylinder(stub_diameter / 2, stub_length, align=HIGH)
    shape += Pos(0, end, 0) * turned * Cylinder(seat_diameter / 2, seat_length, align=LOW)
    middle = end + keyway_start + keyway_length / 2
    shape -= Pos(0, middle, seat_diameter / 2 - keyway_depth) * Box(keyway_width, keyway_length, seat_diameter, align=LOW)
    return shape, {
        "bearing": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "key": {"o": (0, journal_length-shoulder_start+keyway_start+keyway_length/2, seat_diameter/2-keyway_depth), "z": (0, 0, 1), "x": (1, 0, 0)},
        "ring": {"o": (0, shoulder_start, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
