from build123d import Align, Axis, Box, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    w, front, back, t = d["width"], d["front"], d["back"], d["thickness"]
    plate = Pos(0, -front, 0) * Box(w, front + back, t, align=(Align.CENTER, Align.MIN, Align.MIN))
    plate = fillet(plate.edges().filter_by(Axis.Z), radius=d["corner_radius"])
    shape = plate + Cylinder(d["socket_radius"], d["socket_top"], align=UP)
    shape -= Pos(0, 0, d["floor_z"]) * Cylinder(d["bore_radius"], d["socket_top"] - d["floor_z"] + 1, align=UP)
    inset = d["hole_inset"]
    for x in (-(w / 2 - inset), w / 2 - inset):
        for y in (-front + inset, back - inset):
            shape -= Pos(x, y, -1) * Cylinder(d["hole_radius"], t + 2, align=UP)
    return shape, {"socket": {"o": (0, 0, d["floor_z"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
