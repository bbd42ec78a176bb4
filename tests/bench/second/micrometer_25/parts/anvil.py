from build123d import Align, Axis, Cylinder, chamfer


def anvil(spindle_d, long=12):
    pin = Cylinder(spindle_d / 2, long, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return chamfer(pin.edges().sort_by(Axis.Z)[-1], 0.5)
