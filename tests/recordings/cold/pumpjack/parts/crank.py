from math import cos, radians, sin

from build123d import Align, Box, Cylinder, Line, Plane, Pos, Rot, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    y0, t, throw = d["web_start"], d["web_thickness"], d["throw"]
    r, half = d["weight_radius"], radians(d["weight_half_deg"])
    on_base = (Align.CENTER, Align.CENTER, Align.MIN)
    upper, lower = (-r * cos(half), r * sin(half)), (-r * cos(half), -r * sin(half))
    sector = make_face([Line((0, 0), upper), ThreePointArc(upper, (-r, 0), lower), Line(lower, (0, 0))])
    weight = Pos(0, y0 + t, 0) * extrude(Plane.XZ * sector, amount=t)  # y from y0 + t back to y0
    hub = Pos(0, y0, 0) * Rot(X=-90) * Cylinder(d["hub_radius"], t, align=on_base)
    arm = Pos(0, y0, 0) * Box(throw, t, 2 * d["end_radius"], align=(Align.MIN, Align.MIN, Align.CENTER))
    end = Pos(throw, y0, 0) * Rot(X=-90) * Cylinder(d["end_radius"], t, align=on_base)
    shape = hub + weight + arm + end
    length = d["shaft_length"] + y0 + t / 2  # reaches into the web
    shape += Pos(0, -d["shaft_length"], 0) * Rot(X=-90) * Cylinder(d["shaft_radius"], length, align=on_base)
    shape -= Pos(throw, y0 + t / 2, 0) * Rot(X=-90) * Cylinder(d["pin_hole_radius"], t + 2)
    z, x = (0, -1, 0), (1, 0, 0)
    return shape, {
        "shaft": {"o": (0, 0, 0), "z": z, "x": x},
        "end": {"o": (0, -d["shaft_length"], 0), "z": z, "x": x},
        "pin": {"o": (throw, y0, 0), "z": z, "x": x},
    }
