from build123d import Align, Axis, Cylinder, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def grip(tang_d, tang, across=30, tall=90):
    wood = Cylinder(across / 2, tall, align=UP)
    wood = fillet(wood.edges().sort_by(Axis.Z)[-1], 4)
    return wood - Cylinder(tang_d / 2, tang, align=UP)
