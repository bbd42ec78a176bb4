from build123d import Align, Axis, Cylinder, Plane, Polyline, Pos, Rot, make_face, revolve

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    r, body, tip, length = d["radius"], d["body_end"], d["tip_radius"], d["length"]
    ring, ring_top = d["ring_radius"], d["ring_top"]
    outline = Polyline(
        (0, 0), (r, 0), (r, -ring_top), (ring, -ring_top), (ring, -body), (r, -body), (tip, -length), (0, -length),
        close=True,
    )
    shape = revolve(Plane.XZ * make_face(outline), axis=Axis.Z, revolution_arc=360)
    depth = d["hole_depth"]
    shape -= Pos(0, 0, -depth) * Cylinder(d["hole_radius"], depth + 1, align=UP)
    shape -= Pos(0, 0, -length - 1) * Cylinder(d["drill_radius"], length - d["drill_top"] + 1, align=UP)
    z = -(body + ring_top) / 2
    floor = d["key_hole_floor"]
    hole = Pos(0, -floor, z) * Rot(X=90) * Cylinder(d["key_hole_radius"], ring - floor + 1, align=UP)
    for k in range(3):
        shape -= Rot(Z=120 * k) * hole
    return shape, {"seat": {"o": (0, 0, -depth), "z": (0, 0, 1), "x": (1, 0, 0)}}
