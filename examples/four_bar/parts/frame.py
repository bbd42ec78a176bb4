from build123d import Align, Box, Cylinder, Pos, Rot

CORNER = (Align.MIN, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    left, bottom, width = d["left"], d["bottom"], d["right"] - d["left"]
    frame = Pos(left, 0, bottom) * Box(width, d["board"], d["top"] - bottom, align=CORNER)
    frame += Pos(left, (d["board"] - d["foot_depth"]) / 2, bottom - d["foot_height"]) * Box(
        width, d["foot_depth"], d["foot_height"], align=CORNER
    )
    connectors = {}
    for name, x in (("crank", 0), ("rocker", d["span"])):
        frame -= Pos(x, 0, 0) * Rot(X=90) * Cylinder(d["shaft_radius"] + d["clearance"], 4 * d["board"])
        connectors[name] = {"o": (x, -d["play"] / 2, 0), "z": (0, -1, 0), "x": (1, 0, 0)}
    return frame, connectors
