from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, out, top, shoulder, shoulder_low = d["diameter"], d["out"], d["top"], d["shoulder"], d["shoulder_low"]
    shoulder_height = d["shoulder_height"]
    shape = Pos(0, 0, -out) * Cylinder(diameter / 2, out + top, align=LOW)
    shape += Pos(0, 0, shoulder_low) * Cylinder(shoulder / 2, shoulder_height, align=LOW)
    return shape, {
        "body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "knob": {"o": (0, 0, top - 13), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
