from build123d import Align, Box, Cylinder, Pos, Rot, Sphere

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions

    def disc(radius, y0, y1):
        return Pos(0, (y0 + y1) / 2, 0) * Rot(X=90) * Cylinder(radius, y1 - y0)

    def block(x, y, z0, z1):
        return Pos(0, 0, z0) * Box(x, y, z1 - z0, align=UP)

    rod_r, front = d["rod_radius"], d["front_end"]
    shape = disc(rod_r, -front, d["back_end"])
    shape += disc(d["collar_radius"], d["collar_start"], d["collar_end"])
    shape += disc(d["collar_radius"], -d["collar_end"], -d["collar_start"])
    shape += block(d["torso_depth"], d["figure_width"], -d["torso_bottom"], d["torso_top"])
    shape += Pos(0, 0, d["head_z"]) * Sphere(d["head_radius"])
    shape += block(d["foot_depth"], d["leg_width"], -d["foot_top"] - 1, -d["torso_bottom"] + 1)
    shape += block(d["foot_depth"], d["figure_width"], -d["foot_bottom"], -d["foot_top"])
    shape -= Pos(0, -d["flat_start"], d["flat_height"]) * Box(
        2 * rod_r + 2, front - d["flat_start"] + 1, rod_r, align=(Align.CENTER, Align.MAX, Align.MIN)
    )
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "handle_seat": {"o": (0, -d["flat_start"], 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
