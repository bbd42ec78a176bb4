from build123d import Cylinder, PolarLocations, Pos, Rot


def along_z(radius, z0, z1):
    return Pos(0, 0, (z0 + z1) / 2) * Cylinder(radius, z1 - z0)


def build(part):
    d = part.dimensions
    half, left, right = d["thickness"] / 2, d["hub_left"], d["hub_right"]
    # built round Z, then turned so that Z goes to +X
    wheel = along_z(d["radius"], -half, half) + along_z(d["hub_radius"], -left, right)
    wheel -= along_z(d["bore_radius"], -left - 1, right + 1)
    for loc in PolarLocations(d["hole_circle"], 5):
        wheel -= loc * along_z(d["hole_radius"], -half - 1, half + 1)
    shape = Rot(Y=90) * wheel
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
