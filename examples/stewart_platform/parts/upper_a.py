from build123d import Align, Box, Cylinder, Pos, Sphere

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    rod_length = d["length"] - d["neck_length"]
    rod = Cylinder(d["rod_radius"], rod_length, align=HIGH) & Box(2 * d["flat"], 4 * d["rod_radius"], rod_length, align=HIGH)
    upper = Pos(0, 0, -d["neck_length"]) * rod + Cylinder(d["neck_radius"], d["neck_length"], align=HIGH) + Sphere(d["ball_radius"])
    return upper, {
        "rod": {"o": (0, 0, -d["mouth"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "ball": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
