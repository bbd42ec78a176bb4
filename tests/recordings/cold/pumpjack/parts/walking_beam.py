from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    rear, front, width, height = d["rear_end"], d["front_end"], d["width"], d["height"]
    start = (Align.MIN, Align.CENTER, Align.CENTER)
    shape = Pos(-rear, 0, 0) * Box(rear + front, width, height, align=start)
    shape += Rot(X=90) * Cylinder(d["hub_radius"], 2 * d["hub_half"])
    shape += Rot(X=90) * Cylinder(d["trunnion_radius"], 2 * d["trunnion_end"])
    slot_length = rear - d["slot_front"] + 1
    shape -= Pos(-rear - 1, 0, 0) * Box(slot_length, d["slot_width"], height + 2, align=start)
    shape -= Pos(-d["pin_x"], 0, 0) * Rot(X=90) * Cylinder(d["pin_hole_radius"], width + 2)
    end = d["trunnion_end"]
    return shape, {
        "trunnion_front": {"o": (0, -end, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "trunnion_back": {"o": (0, end, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "head": {"o": (front, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "wrist": {"o": (-d["pin_x"], -width / 2, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
