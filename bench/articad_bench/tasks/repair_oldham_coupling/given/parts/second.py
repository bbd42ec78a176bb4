from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    shaft, block_x, shaft_end, hub, hub_start = d["shaft"], d["block_x"], d["shaft_end"], d["hub"], d["hub_start"]
    hub_width, tongue, tongue_end = d["hub_width"], d["tongue"], d["tongue_end"]
    shape = Pos(hub_start, 0, 0) * Rot(Y=90) * Cylinder(hub / 2, hub_width, align=LOW)
    shape += Pos(hub_start, 0, 0) * Rot(Y=90) * Cylinder(shaft / 2, shaft_end - hub_start, align=LOW)
    bar = Pos((tongue_end + hub_start + 1) / 2, 0, 0) * Box(hub_start + 1 - tongue_end, hub, tongue)
    shape += bar & (Rot(Y=90) * Cylinder(hub / 2, 4 * hub_width))
    return shape, {
        "bearing": {"o": (block_x, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
        "tongue": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
