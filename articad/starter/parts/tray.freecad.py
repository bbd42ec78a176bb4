"""The tray as a FreeCAD feature tree.

Every number is a text with the plan's names: FreeCAD keeps it as an expression, so that the dimensions can be edited there.
"""


def build(part):
    part.box(("-width / 2", 0, 0), ("width", "depth", "height"), name="Outside")
    part.box(("-width / 2 + wall", "wall", "wall"), ("width - 2 * wall", "depth - 2 * wall", "height"), cut=True, name="Inside")
    return part.body, {"hinge": part.connector("hinge", (0, "depth", "height + gap"), (-1, 0, 0), (0, -1, 0))}
