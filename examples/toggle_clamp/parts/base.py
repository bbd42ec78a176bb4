from build123d import Align, Box, Circle, Cylinder, Plane, Pos, Rectangle, Rot, extrude, make_hull

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    floor, left, right = d["foot_z"], d["left"], d["right"]
    arm, handle = Pos(0, 0), Pos(d["handle_x"], d["handle_z"])
    inside, cheek, width = d["cheek_y"], d["cheek"], d["handle_x"] - 2 * d["eye"]

    sill = Pos(d["handle_x"] / 2, floor + 1) * Rectangle(-width, 2)
    shapes = [arm * Circle(d["eye"]), handle * Circle(d["eye"]), sill]
    outline = make_hull([edge for shape in shapes for edge in shape.edges()])
    outline -= [place * Circle(d["bore_radius"]) for place in (arm, handle)]
    base = extrude(Plane.XZ.offset(inside) * outline, cheek) + extrude(Plane.XZ.offset(-inside - cheek) * outline, cheek)

    depth = 2 * (inside + cheek + d["flange"])
    base += Pos((left + right) / 2, 0, floor) * Box(right - left, depth, d["thickness"], align=LOW)
    for x in (left + d["flange"] / 2, right - d["flange"] / 2):
        for y in (-depth / 2 + d["flange"] / 2, depth / 2 - d["flange"] / 2):
            base -= Pos(x, y, floor) * Cylinder(d["hole_radius"], 4 * d["thickness"])
    base += Pos(d["stop_x"], 0, d["stop_z"]) * Rot(X=90) * Cylinder(d["stop_radius"], 2 * inside + cheek)
    axis = {"z": (0, -1, 0), "x": (1, 0, 0)}
    return base, {"arm": {"o": (0, 0, 0), **axis}, "handle": {"o": (d["handle_x"], 0, d["handle_z"]), **axis}}
