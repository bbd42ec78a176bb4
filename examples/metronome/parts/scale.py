from build123d import Align, Box, Cylinder, Plane, Polygon, Pos, Rot, extrude


def build(part):
    d = part.dimensions
    low, top, height, thick = d["bottom_width"] / 2, d["top_width"] / 2, d["height"], d["thickness"]
    outline = Plane.XZ * Polygon((-low, 0), (low, 0), (top, height), (-top, height), align=None)
    plate = extrude(outline, thick)  # Plane.XZ looks along -Y
    plate -= Pos(0, 0, d["bore_z"]) * Rot(X=90) * Cylinder(d["bore_radius"], 4 * thick)

    # engraving, a fifth of the thickness deep
    depth = thick / 5
    first, last, count = d["first_mark"], d["last_mark"], d["mark_count"]
    marks = [Pos(0, -thick, first) * Box(0.8, 2 * depth, last - first, align=(Align.CENTER, Align.CENTER, Align.MIN))]
    for i in range(count):
        z = first + (last - first) * i / (count - 1)
        half = low + (top - low) * z / height  # half the plate's width there
        side = 1 if i % 2 else -1
        marks.append(Pos(side * (half * 0.5 + 1), -thick, z) * Box(half * 0.6, 2 * depth, 0.8))
    return plate - marks, {"back": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
