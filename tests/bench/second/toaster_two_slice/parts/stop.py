from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def stop(wall, stroke, boss=5, shaft=8, head=16, thick=9):
    """A button on a stem, with a collar that stops it from inside."""
    reach = wall + boss + 3
    stem = Pos(0, 0, -reach) * Cylinder(shaft / 2, reach + stroke + 1, align=LOW)
    stem += Pos(0, 0, stroke + 0.2) * Cylinder(head / 2, thick, align=LOW)
    return stem + Pos(0, 0, -reach) * Cylinder(shaft / 2 + 2, 3, align=LOW)
