"""The lid as a FreeCAD feature tree, drawn in its own frame: the plan's rest_pose puts it on the tray."""


def build(part):
    part.box(("-width / 2", "-depth", 0), ("width", "depth", "wall"), name="Plate")
    return part.body, {"hinge": part.connector("hinge", (0, 0, 0), (-1, 0, 0), (0, -1, 0))}
