from build123d import Align, Cylinder, Pos, RegularPolygon, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    low, high = d["low"], d["high"]
    spindle = Pos(0, 0, -low) * Cylinder(d["radius"], low + high, align=LOW)
    spindle += Pos(0, 0, high) * extrude(RegularPolygon(d["head_size"] / 2, 6, major_radius=False), d["head_height"])
    spindle += Pos(0, 0, -low - d["spigot_length"]) * Cylinder(d["spigot_radius"], 2 * d["spigot_length"], align=LOW)
    return spindle, {
        "thread": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "tip": {"o": (0, 0, -low), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
