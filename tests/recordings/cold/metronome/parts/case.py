from build123d import Align, Box, Cylinder, Polygon, Pos, Rot, loft

UP = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MAX, Align.MIN)


def build(part):
    d = part.dimensions
    half, top_half, height, wall = d["half"], d["top_half"], d["height"], d["wall"]
    slope = (half - top_half) / height

    def section(z, inset):
        h = half - slope * z - inset
        return Pos(0, 0, z) * Polygon((-h, -h), (h, -h), (h, h), (-h, h), align=None)

    body = loft([section(0, 0), section(height, 0)])
    body = body - Pos(0, -d["front_y"], d["front_edge"]) * Box(2 * half + 2, 2 * half, height, align=FRONT)

    cavity = loft([section(-1, wall), section(height - d["top_plate"], wall)])
    inner_y = -(d["front_y"] - d["front_wall"])
    cavity = cavity - Pos(0, inner_y, d["front_edge"]) * Box(2 * half + 2, 2 * half, height, align=FRONT)
    body = body - cavity

    rabbet = 2 * d["rabbet_half"]
    body = body - Pos(0, 0, -1) * Box(rabbet, rabbet, d["rabbet_depth"] + 1, align=UP)
    body = body - Pos(0, d["key_y"], d["key_z"]) * Rot(Y=90) * Cylinder(d["key_hole_radius"], half + 2, align=UP)
    depth = d["catch_bore_depth"]
    body = body - Pos(0, -d["catch_y"], height - depth) * Cylinder(d["catch_bore_radius"], depth + 1, align=UP)

    return body, {
        "board_seat": {"o": (d["seat_x"], 0, d["rabbet_depth"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "scale_seat": {"o": (0, -d["front_y"], d["scale_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "catch_axis": {"o": (0, -d["catch_y"], height), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
