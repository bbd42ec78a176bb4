from build123d import Align, Axis, Box, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    hs, gy, thickness = d["half_spacing"], d["gear_y"], d["thickness"]
    block = Pos(0, -d["front_reach"], 0) * Box(
        2 * d["front_half_width"], d["front_reach"] + gy, thickness,
        align=(Align.CENTER, Align.MIN, Align.MIN),
    )
    corners = block.edges().filter_by(Axis.Z).group_by(Axis.Y)[0]
    block = fillet(corners, radius=d["corner_radius"])
    shape = Pos(-hs, gy, 0) * Cylinder(d["case_radius"], thickness, align=UP) + block
    for x in (-hs, hs):
        shape -= Pos(x, 0, -1) * Cylinder(d["beater_bore_radius"], thickness + 2, align=UP)
    shape -= Pos(-hs, gy, -1) * Cylinder(d["crank_bore_radius"], thickness + 2, align=UP)
    return shape, {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
