from build123d import Align, Axis, Cylinder, GeomType, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = Rot(Y=-90) * Cylinder(d["radius"], d["length"], align=UP)
    free_edge = body.edges().filter_by(GeomType.CIRCLE).sort_by(Axis.X)[0]
    body = fillet([free_edge], radius=d["end_round"])
    seat_edge = body.edges().filter_by(GeomType.CIRCLE).sort_by(Axis.X)[-1]
    body = fillet([seat_edge], radius=d["inner_round"])
    stud = Pos(-1, 0, 0) * Rot(Y=90) * Cylinder(d["stud_radius"], d["stud_length"] + 1, align=UP)
    return body + stud, {"seat": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)}}
