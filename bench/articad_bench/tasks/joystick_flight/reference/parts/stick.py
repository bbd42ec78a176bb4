from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
LEFT = (Align.MIN, Align.CENTER, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Sphere(d["ball"]) + Cylinder(d["neck"], 41, align=LOW) + Pos(0, 0, 40) * Cylinder(17, d["stick_height"] - 40, align=LOW)
    for side in (-1, 1):
        body += Pos(10, 7.5 * side, 120) * Box(26, 4, 12, align=LEFT)
    body += Pos(30, 0, 120) * Rot(X=90) * Cylinder(d["trigger_pin"], 19)
    body -= Pos(0, 0, d["stick_height"] - 20) * Cylinder(d["button"] + d["clearance"], 40, align=LOW)

    return body, {
        "stick": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "trigger": {"o": (30, 0, 120), "z": (0, 1, 0), "x": (1, 0, 0)},
        "thumb": {"o": (0, 0, d["stick_height"]), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
