from build123d import Align, Box, Cylinder, Pos, Rot

BLADE = (Align.MAX, Align.CENTER, Align.CENTER)


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def along_y(radius, y0, y1, z):
    return Pos(0, (y0 + y1) / 2, z) * Rot(X=90) * Cylinder(radius, y1 - y0)


def build(part):
    d = part.dimensions
    front, rod_y, drop = -d["arbor_front"], -d["rod_y"], -d["bob_drop"]
    half_width, half_rod, half_bob = d["rod_width"] / 2, d["rod_thickness"] / 2, d["bob_thickness"] / 2

    shape = along_y(d["arbor_radius"], front, d["arbor_rear"], 0)
    shape += along_y(d["hub_radius"], front, -d["hub_back"], 0)
    shape += block(-half_width, half_width, rod_y - half_rod, rod_y + half_rod, drop, d["rod_length"])
    shape += along_y(d["bob_radius"], rod_y - half_bob, rod_y + half_bob, drop)

    # pallets: the blade lies along -X and is turned up (front) or down (rear)
    blade = Box(d["pallet_length"], d["pallet_width"], d["pallet_thickness"], align=BLADE)
    shape += Pos(0, d["pallet_front"], 0) * Rot(Y=d["pallet_deg"]) * blade
    shape += Pos(0, d["pallet_rear"], 0) * Rot(Y=-d["pallet_deg"]) * blade

    rod = part.connectors["rod"]
    connectors = {
        "axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "rod": {"o": (0, rod_y, rod.o[2]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
    return shape, connectors
