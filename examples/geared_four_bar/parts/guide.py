from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    length, gap, wide = d["length"], d["gap"], 2 * d["clearance"]
    behind = (Align.MAX, Align.CENTER, Align.CENTER)
    block = Pos(-gap, 0, 0) * Box(d["depth"], length, d["height"], align=(Align.MAX, Align.CENTER, Align.MIN))
    block -= Pos(0, 0, d["slot_z"]) * Box(d["stem"] + d["tongue_head"] / 2, 2 * length, d["stem_height"] + wide, align=behind)
    head = Box(d["tongue_head"] + wide, 2 * length, d["head_height"] + wide, align=behind)
    block -= Pos(d["clearance"] - d["stem"], 0, d["slot_z"]) * head
    return block, {
        "foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "slot": {"o": (0, 0, d["slot_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
