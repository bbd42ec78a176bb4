from build123d import Box, Cylinder, Plane, Polyline, Pos, Rot, extrude, make_face


def block(x0, x1, y0, y1, z0, z1):
    return Pos((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2) * Box(x1 - x0, y1 - y0, z1 - z0)


def tapered(w0, w1, f0, f1, rear, z0, z1, reach):
    """x from -w to w, y from f to rear; w and f run straight from z0 to z1."""
    front = make_face(Polyline((-w0, z0), (w0, z0), (w1, z1), (-w1, z1), close=True))
    side = make_face(Polyline((f0, z0), (rear, z0), (rear, z1), (f1, z1), close=True))
    return extrude(Plane.XZ * front, amount=reach, both=True) & extrude(Plane.YZ * side, amount=reach, both=True)


def build(part):
    d = part.dimensions
    bottom, top, rear, wall = d["bottom"], d["top"], d["rear"], d["wall"]
    half_bottom, half_top = d["half_bottom"], d["half_top"]
    front_bottom, front_top = d["front_bottom"], d["front_top"]
    reach = half_bottom + half_top + rear + front_top

    def half(z):
        return half_bottom + (half_top - half_bottom) * (z - bottom) / (top - bottom)

    def face(z):
        return front_bottom + (front_top - front_bottom) * (z - bottom) / (top - bottom)

    shape = tapered(half_bottom, half_top, front_bottom, front_top, rear, bottom, top, reach)
    low, high = bottom - 1, top - wall
    shape -= tapered(half(low) - wall, half(high) - wall, face(low) + wall, face(high) + wall,
                     rear + 1, low, high, reach)

    # hinge knuckle and finger lip
    knuckle, radius = d["knuckle_half"], d["knuckle_radius"]
    barrel = Rot(Y=90) * Cylinder(radius, 2 * knuckle)
    shape += barrel + block(-knuckle, knuckle, 0, d["root_y"], d["root_z"], radius)
    shape += block(-d["lip_half"], d["lip_half"], d["lip_front"], d["lip_back"], d["lip_bottom"], d["lip_top"])

    shape -= Rot(Y=90) * Cylinder(d["bore_radius"], 2 * knuckle + 2)
    return shape, {"hinge": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
