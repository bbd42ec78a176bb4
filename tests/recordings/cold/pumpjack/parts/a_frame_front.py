from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude, mirror


def build(part):
    d = part.dimensions
    t, shoulder, tenon = d["thickness"], d["shoulder"], d["tenon"]
    foot_in, foot_out = d["foot_in"], d["foot_out"]
    corners = [
        (-d["top_in"], 0),
        (d["top_out"], 0),
        (foot_out, -shoulder),
        (foot_in, -shoulder),
    ]
    # both=True: independent of the sense in which the corners run round
    leg = Pos(0, -t / 2, 0) * extrude(Plane.XZ * Polygon(*corners, align=None), amount=t / 2, both=True)
    shape = leg + mirror(leg, about=Plane.YZ)
    shape += Rot(X=90) * Cylinder(d["boss_radius"], t, align=(Align.CENTER, Align.CENTER, Align.MIN))
    shape += Pos(0, 0, -d["bar_drop"]) * Box(1.6 * foot_in, t, d["bar_height"], align=(Align.CENTER, Align.MAX, Align.MIN))
    foot_x = -(foot_in + foot_out) / 2
    for x in (foot_x, -foot_x):
        shape += Pos(x, 0, -shoulder - tenon) * Box(foot_out - foot_in, t, tenon, align=(Align.CENTER, Align.MAX, Align.MIN))
    shape -= Pos(0, -t / 2, 0) * Rot(X=90) * Cylinder(d["bore_radius"], t + 2)
    return shape, {
        "foot": {"o": (foot_x, -t / 2, -shoulder - tenon), "z": (0, 0, 1), "x": (1, 0, 0)},
        "bearing": {"o": (0, -t, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
