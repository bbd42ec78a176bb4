from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    outside_diameter, spacing, height, chamber_diameter, chamber_depth, bearing_diameter = d["outside_diameter"], d["spacing"], d["height"], d["chamber_diameter"], d["chamber_depth"], d["bearing_diameter"]
    blind_bearing_depth, port_diameter, port_height, tapped_diameter, tapped_depth, dowel_diameter = d["blind_bearing_depth"], d["port_diameter"], d["port_height"], d["tapped_diameter"], d["tapped_depth"], d["dowel_diameter"]
    dowel_depth, rim_radius = d["dowel_depth"], d["rim_radius"]
    left, right = Pos(-spacing / 2, 0, 0), Pos(spacing / 2, 0, 0)
    shape = Box(spacing, outside_diameter, height, align=LOW)
    shape += left * Cylinder(outside_diameter / 2, height, align=LOW) + right * Cylinder(outside_diameter / 2, height, align=LOW)
    for place in (left, right):
        shape -= place * Pos(0, 0, height) * Cylinder(chamber_diameter / 2, chamber_depth, align=HIGH)
    shape -= left * Cylinder(bearing_diameter / 2, 4 * height)
    shape -= right * Pos(0, 0, height - chamber_depth) * Cylinder(bearing_diameter / 2, blind_bearing_depth, align=HIGH)
    shape -= Pos(0, 0, port_height) * Rot(X=90) * Cylinder(port_diameter / 2, 2 * outside_diameter)
    for angle in (90, 180, 270):
        shape -= left * Rot(Z=angle) * Pos(rim_radius, 0, height) * Cylinder(tapped_diameter / 2, tapped_depth, align=HIGH)
        shape -= right * Rot(Z=angle - 180) * Pos(rim_radius, 0, height) * Cylinder(tapped_diameter / 2, tapped_depth, align=HIGH)
    for place, angle in ((left, 135), (right, -30)):
        shape -= place * Rot(Z=angle) * Pos(rim_radius, 0, height) * Cylinder(dowel_diameter / 2, dowel_depth, align=HIGH)
    return shape, {
        "face": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
