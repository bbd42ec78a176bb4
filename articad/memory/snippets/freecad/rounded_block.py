"""A block whose top edges are rounded and whose lower edges are bevelled

Shows: part.fillet, PartDesign::Fillet, part.chamfer, PartDesign::Chamfer
Dimensions: {"width": 40, "depth": 30, "height": 20, "corner": 5, "bevel": 1}
"""


def build(part):
    part.box(("-width / 2", "-depth / 2", 0), ("width", "depth", "height"))
    part.fillet("+Z", "corner")
    part.chamfer("-Z", "bevel")
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
