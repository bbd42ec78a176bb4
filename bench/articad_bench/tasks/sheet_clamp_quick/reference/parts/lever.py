from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    cam_diameter, eccentricity, width, slot_width, bore_diameter, handle_start = d["cam_diameter"], d["eccentricity"], d["width"], d["slot_width"], d["bore_diameter"], d["handle_start"]
    handle_length, handle_height = d["handle_length"], d["handle_height"]
    shape = Pos(0, 0, -eccentricity) * Rot(X=90) * Cylinder(cam_diameter / 2, width)
    shape += Box(handle_length, width, handle_height, align=(Align.MIN, Align.CENTER, Align.CENTER))
    shape -= Box(2 * handle_start, slot_width, 4 * cam_diameter)
    shape -= Rot(X=90) * Cylinder(bore_diameter / 2, 2 * width)
    return shape, {
        "pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
