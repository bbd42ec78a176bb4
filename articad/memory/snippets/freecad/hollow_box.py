"""Hollow out a box to thin walls, open at the top

Shows: PartDesign::Thickness, part.box
Dimensions: {"width": 60, "depth": 40, "height": 30, "wall": 2}
"""


def build(part):
    block = part.box(("-width / 2", "-depth / 2", 0), ("width", "depth", "height"))
    part.settle()
    top = max(range(len(block.Shape.Faces)), key=lambda index: block.Shape.Faces[index].CenterOfMass.z)
    shell = part.body.newObject("PartDesign::Thickness", "Shell")
    shell.Base = (block, [f"Face{top + 1}"])
    shell.Reversed = True
    part.tie(shell, "Value", "wall")
    part.body.Tip = shell
    return part.body, {"mount": part.connector("mount", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
