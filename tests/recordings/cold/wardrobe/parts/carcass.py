from build123d import Align, Box, Cylinder, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def build(part):
    d = part.dimensions
    half = d["width"] / 2
    front, back, height = d["front"], d["back"], d["height"]
    p, floor_z = d["panel"], d["floor_z"]
    inner_front = -front + d["setback"]
    lap = 1.0

    shape = block(-half, half, -front, back, 0, p)
    shape += block(-half, half, -front, back, floor_z, floor_z + p)
    shape += block(-half, half, -front, back, height - p, height)
    shape += block(-half, -half + p, inner_front, back, 0, height)
    shape += block(half - p, half, inner_front, back, 0, height)
    shape += block(-half, half, back - d["back_panel"], back, 0, height)
    shape += block(-p / 2, p / 2, inner_front, back, p - lap, floor_z + lap)

    # runner strips, let into panel and back by lap
    rz0, rz1 = d["runner_z"], d["runner_z"] + d["runner_height"]
    ry1 = back - d["back_panel"] + lap
    side = -half + p
    for x0, x1 in (
        (side - lap, side + d["runner_depth"]),
        (-p / 2 - d["runner_depth"], -p / 2 + lap),
        (p / 2 - lap, p / 2 + d["runner_depth"]),
        (-side - d["runner_depth"], -side + lap),
    ):
        shape += block(x0, x1, inner_front, ry1, rz0, rz1)

    # blind pivot bores; the cutters start 1 mm outside the face
    depth, r = d["bore_depth"], d["bore_radius"]
    for x in (-d["pivot_x"], d["pivot_x"]):
        shape -= Pos(x, -d["pivot_y"], floor_z + p - depth) * Cylinder(
            r, depth + 1, align=(Align.CENTER, Align.CENTER, Align.MIN))
        shape -= Pos(x, -d["pivot_y"], height - p + depth) * Cylinder(
            r, depth + 1, align=(Align.CENTER, Align.CENTER, Align.MAX))

    drawer_x = (d["width"] - p) / 4
    up, right, left = (0, 0, 1), (1, 0, 0), (-1, 0, 0)
    down, out = (0, 0, -1), (0, -1, 0)
    connectors = {
        "hinge_left": {"o": (-d["pivot_x"], -d["pivot_y"], d["door_z"]), "z": down, "x": right},
        "hinge_right": {"o": (d["pivot_x"], -d["pivot_y"], d["door_z"]), "z": down, "x": left},
        "runner_left": {"o": (-drawer_x, -front, d["drawer_z"]), "z": out, "x": right},
        "runner_right": {"o": (drawer_x, -front, d["drawer_z"]), "z": out, "x": left},
        "foot_front_left": {"o": (-d["foot_x"], -d["foot_front"], 0), "z": up, "x": right},
        "foot_front_right": {"o": (d["foot_x"], -d["foot_front"], 0), "z": up, "x": right},
        "foot_back_left": {"o": (-d["foot_x"], d["foot_back"], 0), "z": up, "x": right},
        "foot_back_right": {"o": (d["foot_x"], d["foot_back"], 0), "z": up, "x": right},
        "rail": {"o": (-half + p, d["rail_y"], d["rail_z"]), "z": right, "x": up},
    }
    return shape, connectors
