from build123d import Box, Cylinder, Pos, Rot


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def build(part):
    d = part.dimensions
    count, width, pitch = d["slat_count"], d["slat_width"], d["slat_pitch"]
    low, high = d["slat_bottom"], d["slat_bottom"] + d["slat_thickness"]
    half = d["slat_length"] / 2
    inner, outer = d["bearer_inner_y"], d["bearer_outer_y"]
    # the bearers always reach the last slat, also when there is one more
    last_middle = d["right_end"] - width / 2 - (count - 1) * pitch
    left = min(-d["bearer_left"], last_middle)
    shape = block(left, d["bearer_right"], inner, outer, -d["bearer_depth"], low)
    for i in range(count):
        x1 = d["right_end"] - i * pitch
        shape += block(x1 - width, x1, -half, half, low, high)
    shape += block(left, d["bearer_right"], -outer, -inner, -d["bearer_depth"], low)
    reach = outer + (outer - inner)
    shape -= Rot(X=90) * Cylinder(d["bore_radius"], 2 * reach)
    h = d["slot_half_height"]
    shape -= block(-d["slot_left"], -d["slot_right"], -reach, reach, -h, h)
    return shape, {
        "hinge": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "slot": {"o": (-d["slot_rest"], 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
