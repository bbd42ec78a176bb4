from build123d import Align, Cylinder, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    eye_diameter, eye_width, bore_diameter, diameter, reach = d["eye_diameter"], d["eye_width"], d["bore_diameter"], d["diameter"], d["reach"]
    shape = Rot(X=90) * Cylinder(eye_diameter / 2, eye_width) + Rot(Y=90) * Cylinder(diameter / 2, reach, align=LOW)
    shape -= Rot(X=90) * Cylinder(bore_diameter / 2, 4 * eye_width)
    return shape, {
        "eye": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "thread": {"o": (34, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
