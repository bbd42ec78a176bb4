from build123d import Axis, Box, Plane, Polygon, extrude, fillet


def build(part):
    d = part.dimensions
    low, top, height, depth = d["bottom_width"] / 2, d["top_width"] / 2, d["height"], d["depth"]
    outline = Plane.XZ * Polygon((-low, 0), (low, 0), (top, height), (-top, height), align=None)
    block = extrude(outline, depth / 2, both=True)
    block = fillet(block.edges().group_by(Axis.Y)[0], 1)
    block -= Box(d["slot_width"], d["slot_depth"], 4 * height)
    return block, {"hole": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
