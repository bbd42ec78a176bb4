from build123d import Align, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    half = d["length"] / 2
    along_x = Rot(Y=90)
    flange = along_x * Cylinder(d["flange_radius"], d["flange_thickness"],
                                align=(Align.CENTER, Align.CENTER, Align.MIN))
    rail = along_x * Cylinder(d["rod_radius"], d["length"])
    rail += Pos(-half, 0, 0) * flange
    rail += Pos(half - d["flange_thickness"], 0, 0) * flange
    return rail, {"end_left": {"o": (-half, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
