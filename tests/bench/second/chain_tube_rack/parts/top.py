from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness, hole, pitch = d["length"], d["width"], d["thickness"], d["hole"], d["pitch"]
    post_x, post_y = d["post_x"], d["post_y"]
    columns, rows, row_pitch = d["columns_count"], d["rows_count"], d["row_pitch"]
    shape = Box(length, width, thickness, align=LOW) - GridLocations(pitch, row_pitch, columns, rows) * Cylinder(hole / 2, 3 * thickness)
    return shape, {"post": {"o": (post_x, post_y, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
