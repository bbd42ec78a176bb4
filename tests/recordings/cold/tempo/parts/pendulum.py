from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    drop, top = d["bob_drop"], d["rod_top"]
    shape = Pos(0, 0, -drop) * Box(2 * d["rod_half_x"], 2 * d["rod_half_y"], top + drop,
                                   align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape += Rot(X=-90) * Cylinder(d["hub_radius"], 2 * d["hub_half"])
    shape += Pos(0, 0, -drop) * Rot(X=-90) * Cylinder(d["bob_radius"], 2 * d["bob_half"])
    shape -= Rot(X=-90) * Cylinder(d["bore_radius"], 2 * d["hub_half"] + 4)
    return shape, {
        "hub": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "rail": {"o": (0, 0, d["rail_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
