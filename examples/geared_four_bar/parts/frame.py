from build123d import Align, Box, Cylinder, Pos

HIGH = (Align.MIN, Align.MIN, Align.MAX)


def build(part):
    d = part.dimensions
    left, front, top = d["left"], d["front"], -d["play"] / 2
    width, depth, post = d["right"] - left, d["back"] - front, d["post_size"]
    frame = Pos(left, front, top) * Box(width, depth, d["thickness"], align=HIGH)
    for x in (left, d["right"] - post):
        for y in (front, d["back"] - post):
            frame += Pos(x, y, top - d["thickness"]) * Box(post, post, d["post_height"], align=HIGH)

    connectors = {"guide": {"o": (d["guide_x"], 0, top), "z": (0, 0, 1), "x": (1, 0, 0)}}
    for name, x in (("pinion", -d["distance"]), ("crank", 0), ("rocker", d["span"])):
        frame -= Pos(x, 0, 0) * Cylinder(d["shaft_radius"] + d["clearance"], 4 * d["thickness"])
        connectors[name] = {"o": (x, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}
    return frame, connectors
