from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    rear, front, half = d["rear"], d["front"], d["half_width"]
    along = (Align.MIN, Align.CENTER, Align.CENTER)
    body = Pos(-rear, 0, 0) * Box(rear + front, 2 * half, 2 * d["half_height"], align=along)
    # both keys as one bar across the block, before the fork slot is cut
    body += Pos(-d["key_rear"], 0, 0) * Box(
        d["key_rear"] + d["key_front"], 2 * d["key_reach"], 2 * d["key_half"], align=along)
    body -= Pos(-d["fork_end"], 0, 0) * Box(
        d["fork_end"] + front + 1, 2 * d["fork_half"], 2 * d["half_height"] + 2, align=along)
    body += Rot(X=90) * Cylinder(d["pin_radius"], d["fork_half"] + half)
    # T-shaped cavity from the rear face
    up = (Align.CENTER, Align.CENTER, Align.MIN)
    body -= Pos(-rear - 1, 0, 0) * Rot(Y=90) * Cylinder(
        d["neck_bore_radius"], 1 + d["lip"] + d["cavity"] / 2, align=up)
    body -= Pos(-rear + d["lip"], 0, 0) * Rot(Y=90) * Cylinder(d["head_bore_radius"], d["cavity"], align=up)
    return body, {
        "link_pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "guide": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "screw_seat": {"o": (-rear, 0, 0), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
