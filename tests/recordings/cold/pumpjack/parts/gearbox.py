from build123d import Align, Cylinder, Plane, Polygon, Pos, Rot, extrude


def build(part):
    d = part.dimensions
    w, depth, h, c = d["width"] / 2, d["depth"], d["height"], d["chamfer"]
    outline = [(-w, 0), (w, 0), (w, h - c), (w - c, h), (-w + c, h), (-w, h - c)]
    shape = extrude(Plane.XZ * Polygon(*outline, align=None), amount=depth / 2, both=True)
    shape -= Pos(0, 0, d["bore_z"]) * Rot(X=90) * Cylinder(d["bore_radius"], depth + 2)
    return shape, {
        "seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "bore": {"o": (0, depth / 2, d["bore_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
