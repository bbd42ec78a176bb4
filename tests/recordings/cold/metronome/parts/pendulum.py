from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    bob_z = d["bob_z"]
    rod = Pos(0, 0, -bob_z) * Box(d["rod_width"], d["rod_thickness"], bob_z + d["rod_top"], align=UP)
    bob = Pos(0, 0, -bob_z) * Rot(X=90) * Cylinder(d["bob_radius"], d["bob_thickness"])
    hub = Rot(X=90) * Cylinder(d["hub_radius"], d["hub_length"])
    shaft = Rot(X=-90) * Cylinder(d["shaft_radius"], d["shaft_length"], align=UP)
    return rod + bob + hub + shaft, {
        "shaft": {"o": (0, d["shaft_seat"], 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "rod": {"o": (0, 0, d["slide_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
