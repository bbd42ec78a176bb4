from build123d import (Align, Box, Cylinder, Line, Plane, Pos, Rot,
                       ThreePointArc, extrude, make_face)


def build(part):
    d = part.dimensions
    t, w = d["thickness"], d["half_width"]
    up, low = d["upper"], d["lower"]
    r, fl = d["sole_radius"], d["foot_length"]
    face = make_face([
        Line((-w, -low), (w, -low)),
        Line((w, -low), (w, up)),
        ThreePointArc((w, up), (0, up + w), (-w, up)),
        Line((-w, up), (-w, -low)),
    ])
    bar = extrude(Plane.YZ * face, amount=t / 2, both=True)
    foot = Pos(0, 0, -low) * Rot(Y=90) * Cylinder(r, fl)
    foot = foot - Pos(0, 0, -low + d["foot_up"]) * Box(
        fl + 2, 2 * r + 2, 2 * r + 2, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape = bar + foot
    shape = shape - Rot(Y=90) * Cylinder(d["crank_bore_radius"], t + 2)
    shape = shape - Pos(0, 0, up) * Rot(Y=90) * Cylinder(d["top_bore_radius"], t + 2)
    return shape, {
        "crank": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "top": {"o": (t / 2, 0, up), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
