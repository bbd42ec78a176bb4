from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude

FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    width, thickness, up, out, rib = d["width"], d["thickness"], d["up"], d["out"], d["rib"]
    rib_side, hole, pitch = d["rib_side"], d["hole"], d["pitch"]
    shape = Pos(0, 0, 0) * Box(width, thickness, up, align=FRONT) + Box(width, out, thickness, align=FRONT)
    corner = Plane.YZ * Polygon((thickness, thickness), (rib_side, thickness), (thickness, rib_side), align=None)
    shape += Pos(-rib / 2, 0, 0) * extrude(corner, rib)
    for x in (-pitch / 2, pitch / 2):
        shape -= Pos(x, 0.75 * out, 0) * Cylinder(hole / 2, 3 * thickness)
        shape -= Pos(x, 0, 0.8 * up) * Rot(X=90) * Cylinder(hole / 2, 3 * thickness)

    return shape, {}
