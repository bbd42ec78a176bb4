from build123d import Box, Cylinder, Pos, Rot


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def build(part):
    d = part.dimensions
    plate, half, inner = d["plate"], d["half_width"], d["inner_x"]
    front, rear, post = d["front_y"], d["rear_y"], d["post_half"]
    height, key_y, key_z, arbor_z = d["height"], d["key_y"], d["key_z"], d["arbor_z"]
    y0, y1 = key_y - d["cheek_half"], key_y + d["cheek_half"]

    shape = block(-half, half, front, rear, 0, plate)
    shape += block(-half, -half + plate, y0, y1, 0, height)
    shape += block(-inner - plate, -inner, y0, y1, 0, height)
    shape += block(half - plate, half, y0, y1, 0, d["right_height"])
    shape += block(-post, post, front, front + plate, 0, height)
    shape += block(-post, post, rear - plate, rear, 0, height)

    shape -= Pos(0, key_y, key_z) * Rot(Y=90) * Cylinder(d["key_bore_radius"], 2 * half + 2)
    x0, x1 = -half - 1, -inner + 1
    shape -= Pos((x0 + x1) / 2, key_y, arbor_z) * Rot(Y=90) * Cylinder(d["arbor_bore_radius"], x1 - x0)
    shape -= Pos(0, (front + rear) / 2, arbor_z) * Rot(X=90) * Cylinder(d["arbor_bore_radius"], rear - front + 2)

    connectors = {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "key": {"o": (0, key_y, key_z), "z": (1, 0, 0), "x": (0, 0, 1)},
        "great": {"o": (part.connectors["great"].o[0], key_y, key_z), "z": (1, 0, 0), "x": (0, 0, 1)},
        "escape": {"o": (0, key_y, arbor_z), "z": (1, 0, 0), "x": (0, 0, 1)},
        "pendulum": {"o": (0, front + plate / 2, arbor_z), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
    return shape, connectors
