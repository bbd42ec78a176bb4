"""All parts turn about z. The crank lies along x, the planet's arm too."""

from build123d import Align, Axis, Circle, Cylinder, Pos, SlotCenterToCenter, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def peg(x, low, high, radius):
    body = Pos(x, 0, low) * Cylinder(radius, high - low, align=UP)
    return chamfer(body.edges().group_by(Axis.Z)[-1], 0.5)


def ring(ring, shy, wall, floor_up, rim_z, crank_z, thick, stud):
    bore = ring / 2 + shy
    body = Cylinder(bore + wall, rim_z, align=UP)
    body = chamfer(body.edges().group_by(Axis.Z)[0], 1)
    body -= Pos(0, 0, floor_up) * Cylinder(bore, rim_z, align=UP)
    return body + peg(0, floor_up / 2, crank_z + thick, stud / 2)


def crank(crank, thick, air, stud, play, wide=20):
    flat = Pos(crank / 2, 0) * SlotCenterToCenter(crank, wide) - Circle(stud / 2 + play)
    return extrude(flat, thick) + peg(crank, thick / 2, 2 * thick + air, stud / 2) + peg(crank, thick - 1, thick + air / 2, stud / 2 + 3)


def planet(crank, planet, shy, thick, air, stud, play, wide=16):
    disc = Cylinder(planet / 2 - shy, thick, align=UP) - Cylinder(stud / 2 + play, thick, align=UP)
    arm = Pos(crank / 2, 0) * SlotCenterToCenter(crank, wide) & Circle(2 * planet)
    step = Pos(0, 0, thick / 2) * Cylinder(wide / 2, thick / 2 + air, align=UP) - Cylinder(stud / 2 + play, 4 * thick, align=UP)
    body = disc + Pos(0, 0, thick + air) * extrude(arm, thick) + step
    return body + peg(crank, 1.5 * thick, 3 * thick + 2 * air - 1, stud / 2)


def pen(thick, stud, play, across=24):
    disc = Cylinder(across / 2, thick, align=UP)
    return fillet(disc.edges().group_by(Axis.Z)[-1], 1) - Cylinder(stud / 2 + play, thick, align=UP)
