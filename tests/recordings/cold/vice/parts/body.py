from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, RectangleRounded, Rot, extrude

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    y0, length, base_h = d["front_y"], d["length"], d["base_height"]
    base = Pos(0, y0 + length / 2, 0) * extrude(
        RectangleRounded(d["base_width"], length, d["corner_radius"]), amount=base_h)
    housing = Pos(0, y0, base_h - 1) * Box(
        d["housing_width"], length, d["housing_top"] - base_h + 1, align=FRONT)
    jaw = Pos(0, y0, d["jaw_bottom"]) * Box(
        d["jaw_width"], d["jaw_depth"], d["jaw_top"] - d["jaw_bottom"], align=FRONT)
    ry, rz = y0 + d["jaw_depth"], d["housing_top"]
    profile = Plane.YZ * Polygon(
        (ry - 1, rz - 1), (ry + d["rib_length"], rz - 1), (ry + d["rib_length"], rz),
        (ry, rz + d["rib_height"]), (ry - 1, rz + d["rib_height"]), align=None)
    rib = extrude(profile, amount=d["rib_width"] / 2, both=True)
    shape = base + housing + jaw + rib

    tb, tt = d["tunnel_bottom"], d["tunnel_top"]
    shape -= Pos(0, y0 - 1, tb) * Box(d["tunnel_width"], length + 2, tt - tb, align=FRONT)

    nut = Pos(0, d["nut_front_y"], tb - 1) * Box(
        d["nut_width"], d["nut_length"], d["nut_top"] - tb + 1, align=FRONT)
    shape += nut
    shape -= Pos(0, d["nut_front_y"] + d["nut_length"] / 2, d["axis_z"]) * Rot(X=-90) * Cylinder(
        d["thread_bore_radius"], d["nut_length"] + 2)

    for x in (-d["hole_x"], d["hole_x"]):
        for y in (d["hole_front_y"], d["hole_back_y"]):
            shape -= Pos(x, y, base_h / 2) * Cylinder(d["hole_radius"], base_h + 2)

    return shape, {
        "tunnel": {"o": (0, y0, (tb + tt) / 2), "z": (0, 1, 0), "x": (1, 0, 0)},
        "nut": {"o": (0, d["nut_front_y"], d["axis_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "jaw_face": {"o": (0, y0, d["plate_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
