from build123d import Align, Axis, Box, Cylinder, Plane, Polygon, Pos, Rot, revolve

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, width, groove, groove_bottom, groove_depth = d["outside"], d["width"], d["groove"], d["groove_bottom"], d["groove_depth"]
    hub, hub_length, bore, key, key_bottom = d["hub"], d["hub_length"], d["bore"], d["key"], d["key_bottom"]
    screw = d["screw"]
    shape = Cylinder(outside / 2, width, align=LOW) + Cylinder(hub / 2, width + hub_length, align=LOW)
    r, mid = outside / 2, width / 2
    vee = Plane.XZ * Polygon((r - groove_depth, mid - groove_bottom / 2), (r, mid - groove / 2), (r + 1, mid - groove / 2), (r + 1, mid + groove / 2), (r, mid + groove / 2), (r - groove_depth, mid + groove_bottom / 2), align=None)
    shape -= revolve(vee, Axis.Z)
    shape -= Cylinder(bore / 2, 4 * width)
    shape -= Pos(0, 0, 0) * Box(key, 2 * key_bottom, 4 * width) - Pos(0, -outside, 0) * Box(outside, 2 * outside, 4 * width)
    shape -= Pos(0, 0, width + hub_length / 2) * Rot(X=90) * Cylinder(screw / 2, outside, align=LOW)
    return shape, {}
