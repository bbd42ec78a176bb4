from build123d import Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face


def along_z(radius, z0, z1):
    return Pos(0, 0, (z0 + z1) / 2) * Cylinder(radius, z1 - z0)


def build(part):
    d = part.dimensions
    outer, inner = d["crown_radius"], d["rim_inner"]
    back, floor, root, tip = -d["disc_left"], -d["disc_right"], -d["rim_right"], -d["tip"]
    count, wide, narrow = d["tooth_count"], d["root_width"], d["tip_width"]
    # built round Z, then turned so that Z goes to +X
    blank = along_z(outer + 1, back, root)
    deep = (floor + root) / 2
    profile = make_face(Polyline((0, deep), (wide, deep), (wide, root), (narrow, tip), (0, tip), close=True))
    tooth = Pos(inner - 1, 0, 0) * extrude(Plane.YZ * profile, amount=outer - inner + 2)
    for i in range(count):
        blank += Rot(Z=360 * i / count) * tooth
    wheel = blank & along_z(outer, back - 1, tip + 1)
    wheel -= along_z(inner, floor, tip + 1)
    wheel += along_z(d["arbor_radius"], -d["arbor_left"], floor)
    wheel += along_z(d["pinion_radius"], -d["pinion_left"], -d["pinion_right"])
    shape = Rot(Y=90) * wheel
    return shape, {"axis": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
