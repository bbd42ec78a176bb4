from build123d import Box, Cylinder, Plane, Polygon, Pos, Rot, extrude


def build(part):
    d = part.dimensions
    reach, root, tip, thickness, hub_diameter, hub = d["reach"], d["root"], d["tip"], d["thickness"], d["hub_diameter"], d["hub"]
    bore_diameter, tail, weight_length, weight_height, weight_thickness = d["bore_diameter"], d["tail"], d["weight_length"], d["weight_height"], d["weight_thickness"]
    bar = Polygon((-tail, -root / 2), (0, -root / 2), (reach, -tip / 2), (reach, tip / 2), (0, root / 2), (-tail, root / 2), align=None)
    shape = Pos(0, thickness / 2, 0) * extrude(Plane.XZ * bar, thickness) + Rot(X=90) * Cylinder(hub_diameter / 2, hub)
    shape += Pos(-tail, 0, 0) * Box(weight_length, weight_thickness, weight_height)
    shape -= Rot(X=90) * Cylinder(bore_diameter / 2, 4 * hub)
    return shape, {
        "hub": {"o": (0, hub/2+0.5, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
