from build123d import *


def build(part):
    d = part.dimensions
    handle = Box(d["handle_thickness"], d["handle_width"], d["handle_height"])
    handle = fillet(handle.edges(), radius=d["handle_round"])
    handle = Pos(d["handle_start"] + d["handle_thickness"] / 2, 0, 0) * handle
    stem = Pos(-d["socket_depth"], 0, 0) * Rot(Y=90) * Cylinder(
        d["stem_radius"], d["socket_depth"] + d["handle_start"] + 1, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return handle + stem, {"stem": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
