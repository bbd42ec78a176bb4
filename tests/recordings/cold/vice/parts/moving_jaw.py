from build123d import Align, Box, Cylinder, Pos, Rot

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    t, sb, sh, sl = d["block_thickness"], d["slide_bottom"], d["slide_height"], d["slide_length"]
    upper = Pos(0, -t, d["jaw_bottom"]) * Box(
        d["jaw_width"], t, d["jaw_top"] - d["jaw_bottom"], align=FRONT)
    lower = Pos(0, -t, sb) * Box(d["lower_width"], t, d["jaw_bottom"] - sb + 1, align=FRONT)
    slide = Pos(0, -1, sb) * Box(d["slide_width"], sl + 1, sh, align=FRONT)
    shape = upper + lower + slide
    shape -= Pos(0, 0, sb - 1) * Box(
        d["channel_width"], sl + 1, d["channel_top"] - sb + 1, align=FRONT)
    shape -= Pos(0, -t / 2, d["axis_z"]) * Rot(X=-90) * Cylinder(d["bore_radius"], t + 2)
    return shape, {
        "slide": {"o": (0, d["tunnel_front_y"], sb + sh / 2), "z": (0, 1, 0), "x": (1, 0, 0)},
        "bearing": {"o": (0, -t / 2, d["axis_z"]), "z": (0, 1, 0), "x": (1, 0, 0)},
        "jaw_face": {"o": (0, 0, d["plate_z"]), "z": (0, -1, 0), "x": (-1, 0, 0)},
    }
