from build123d import Align, Axis, Cylinder, Pos, Rot, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    knob = Cylinder(d["radius"], d["length"], align=UP)
    knob = fillet(knob.edges().group_by(Axis.Z)[-1], radius=d["edge_radius"])
    knob -= Pos(0, 0, -1) * Cylinder(d["bore_radius"], d["bore_depth"] + 1, align=UP)
    return Rot(Y=90) * knob, {
        "seat": {"o": (d["bore_depth"], 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)},
    }
