from build123d import Align, Axis, Cylinder, Pos, Rot, chamfer

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def drop_bolt(bolt_d, tall=400, handle=90, handle_d=12, below=15):
    """A rod from z = 0 upwards with a handle along x near its top."""
    rod = Cylinder(bolt_d / 2, tall, align=UP)
    rod = chamfer(rod.edges().sort_by(Axis.Z)[0], 3)
    return rod + Pos(0, 0, tall - below) * Rot(Y=90) * Cylinder(handle_d / 2, handle, align=UP)
