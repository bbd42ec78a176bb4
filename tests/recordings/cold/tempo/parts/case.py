from build123d import Align, Box, Plane, Polyline, Pos, extrude, make_face

CCM = (Align.CENTER, Align.CENTER, Align.MIN)
CMM = (Align.CENTER, Align.MIN, Align.MIN)


def prism(points, y0, y1):
    plane = Plane(origin=(0, y1, 0), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    return extrude(plane * make_face(Polyline(*points, close=True)), amount=y1 - y0)


def build(part):
    d = part.dimensions
    height, depth, wall = d["height"], d["depth"], d["wall"]
    ledge, setback = d["ledge_z"], d["setback"]
    front, back = -depth / 2, depth / 2

    def half(z):
        return d["foot_width"] / 2 - (d["foot_width"] - d["top_width"]) / 2 * z / height

    def outline(z0, z1, inset):
        return [(-(half(z0) - inset), z0), (half(z0) - inset, z0), (half(z1) - inset, z1), (-(half(z1) - inset), z1)]

    shape = prism(outline(0, height, 0), front, back)
    shape -= Pos(0, front - 1, ledge) * Box(2 * d["foot_width"], setback + 1, height, align=CMM)
    shape -= prism(outline(-1, height - wall, wall), front + setback + wall, back - wall)
    shape -= prism(outline(-1, ledge - wall, wall), front + wall, front + setback + 2 * wall)
    shape -= Pos(0, front + d["slot_inset"], ledge - wall - 1) * Box(
        2 * d["slot_half_x"], 2 * d["slot_half_y"], wall + 2, align=CCM)
    shape -= Pos(0, back - wall - 1, d["opening_bottom"]) * Box(
        2 * d["opening_half_x"], wall + 2, d["opening_top"] - d["opening_bottom"], align=CMM)
    shape -= Pos(0, back - d["rebate_depth"], d["rebate_bottom"]) * Box(
        2 * d["rebate_half_x"], d["rebate_depth"] + 1, d["rebate_top"] - d["rebate_bottom"], align=CMM)
    mid = (d["rebate_bottom"] + d["rebate_top"]) / 2
    return shape, {
        "board": {"o": (0, front + wall, d["board_mid_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "window": {"o": (0, back - d["rebate_depth"], mid), "z": (0, 1, 0), "x": (1, 0, 0)},
        "scale": {"o": (0, front + setback, d["scale_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
