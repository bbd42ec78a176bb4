from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def outline(d, inset, bottom, top):
    radius = d["case_radius"] - inset
    half = d["front_half_width"] - inset
    front = d["front_reach"] - inset
    tall = top - bottom
    block = Pos(0, -front, bottom) * Box(
        2 * half, front + d["gear_y"], tall, align=(Align.CENTER, Align.MIN, Align.MIN)
    )
    corners = block.edges().filter_by(Axis.Z).group_by(Axis.Y)[0]
    block = fillet(corners, radius=d["corner_radius"] - inset)
    disc = Pos(-d["half_spacing"], d["gear_y"], bottom) * Cylinder(radius, tall, align=UP)
    return disc + block


def build(part):
    d = part.dimensions
    hs, gy, height = d["half_spacing"], d["gear_y"], d["height"]
    shape = outline(d, 0, 0, height) - outline(d, d["wall"], d["floor_thickness"], height + 1)

    face_x = -(hs + d["case_radius"] + d["boss_length"])
    boss_end = -(hs + d["case_radius"] - d["wall"] / 2)
    shape += Pos(face_x, gy, d["boss_z"]) * Rot(Y=90) * Cylinder(
        d["boss_radius"], boss_end - face_x, align=UP
    )

    through = d["floor_thickness"] + 2
    for x in (-hs, hs):
        shape -= Pos(x, 0, -1) * Cylinder(d["beater_bore_radius"], through, align=UP)
    shape -= Pos(-hs, gy, -1) * Cylinder(d["crank_bore_radius"], through, align=UP)
    shape -= Pos(face_x - 1, gy, d["boss_z"]) * Rot(Y=90) * Cylinder(
        d["stud_radius"], d["stud_depth"] + 1, align=UP
    )

    right = part.connectors["beater_right"]
    up = (0, 0, 1)
    return shape, {
        "cover": {"o": (0, 0, height), "z": up, "x": (1, 0, 0)},
        "grip": {"o": (face_x, gy, d["boss_z"]), "z": (-1, 0, 0), "x": (0, 0, 1)},
        "beater_left": {"o": (-hs, 0, 0), "z": up, "x": (1, 0, 0)},
        "beater_right": {"o": (hs, 0, 0), "z": right.z, "x": right.x},
        "crank": {"o": (-hs, gy, 0), "z": up, "x": (1, 0, 0)},
    }
