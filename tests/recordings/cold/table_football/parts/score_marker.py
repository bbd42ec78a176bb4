from build123d import Align, Box, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    slot, length, drop = d["slot_width"], d["length"], d["cheek_drop"]
    outer = slot + 2 * d["cheek"]
    shape = Pos(0, 0, -drop) * Box(outer, length, drop + d["roof"], align=UP)
    shape += Box(outer, d["fin"], d["fin_top"], align=UP)
    shape -= Pos(0, 0, -drop - 1) * Box(slot, length + 2, drop + 1, align=UP)
    return shape, {"slide": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
