from build123d import Align, Axis, Box, Cylinder, Pos, fillet

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def dial(wall, play, boss=5, shaft=8, across=32, tall=14.5):
    knob = Pos(0, 0, play) * Cylinder(across / 2, tall, align=LOW)
    knob = fillet(knob.edges().sort_by(Axis.Z)[-1:], 1)
    knob += Pos(-6, 0, play + tall - 1) * Box(12, 3, 2.5, align=LOW)
    knob += Pos(0, 0, -wall - boss - play - 3) * Cylinder(shaft / 2, wall + boss + 2 * play + 4, align=LOW)
    return knob + Pos(0, 0, -wall - boss - play - 3) * Cylinder(shaft / 2 + 2, 3, align=LOW)
