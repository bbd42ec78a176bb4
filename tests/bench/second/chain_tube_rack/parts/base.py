from build123d import Align, Box, Cylinder, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, post, socket = d["length"], d["width"], d["thickness"], d["post"], d["socket"]
    post_x, post_y, dimple, dimple_depth, pitch = d["post_x"], d["post_y"], d["dimple"], d["dimple_depth"], d["pitch"]
    columns, rows, row_pitch = d["columns_count"], d["rows_count"], d["row_pitch"]
    shape = Box(length, width, thickness, align=LOW)
    shape -= Pos(0, 0, thickness - socket) * GridLocations(2 * post_x, 2 * post_y, 2, 2) * Cylinder(post / 2, thickness, align=LOW)
    shape -= (
        Pos(0, 0, thickness - dimple_depth) * GridLocations(pitch, row_pitch, columns, rows) * Cylinder(dimple / 2, thickness, align=LOW)
    )
    return shape, {
        "post_1": {"o": (post_x, post_y, thickness - socket), "z": (0, 0, 1), "x": (1, 0, 0)},
        "post_2": {"o": (-post_x, post_y, thickness - socket), "z": (0, 0, 1), "x": (1, 0, 0)},
        "post_3": {"o": (-post_x, -post_y, thickness - socket), "z": (0, 0, 1), "x": (1, 0, 0)},
        "post_4": {"o": (post_x, -post_y, thickness - socket), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
