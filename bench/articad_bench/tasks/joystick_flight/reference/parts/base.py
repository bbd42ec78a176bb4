from build123d import Align, Box, Cone, Cylinder, Pos, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Pos(0, -30, 0) * Box(d["base_length"], 200, 40, align=LOW) + Cylinder(26, 66, align=LOW)
    body -= Pos(0, 0, 56) * (Sphere(d["ball"] + d["clearance"]) + Cone(0, 40, 20, align=LOW))
    body -= Pos(0, -65, 20) * Box(d["slot_length"], d["slot_width"], 60, align=LOW)

    return body, {
        "stick": {"o": (0, 0, 56), "z": (0, 0, 1), "x": (1, 0, 0)},
        "throttle": {"o": (0, -65, 20), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
