from build123d import Align, Axis, Box, Circle, Cylinder, Pos, Rectangle, Rot, chamfer, extrude, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def along_x(radius, long):
    return Rot(0, 90, 0) * Cylinder(radius, long)


def frame(wide, gap, frame, rail_top, rail_low, gate_high, foot, stile, screw=6):
    """Wall frame y = -frame to 0 with an opening for the gate, screwed to the wall through the upper rail."""
    low = -gate_high - foot
    body = Pos(0, -frame / 2, low) * Box(wide + 2 * gap, frame, rail_top - low, align=UP)
    body -= Pos(0, -frame / 2, -gate_high) * Box(wide - 2 * stile, 2 * frame, gate_high + rail_low, align=UP)
    for x in (-0.4, -0.15, 0.15, 0.4):
        body -= Pos(x * wide, 0, rail_top - 18) * Rot(90, 0, 0) * Cylinder(screw / 2, 3 * frame)
    return body


def cheek(axis_y, board, sheet, stub, stub_long, gap, tall=60):
    """A plate of sheet steel, its inner face at x = 0, with a stub towards +x at the origin."""
    body = Pos(-sheet / 2, -axis_y / 2, 0) * Box(sheet, -axis_y, board, align=(Align.CENTER, Align.CENTER, Align.CENTER))
    body += Pos(-sheet / 2, -axis_y / 2 + 7, -tall / 2 + board / 2) * Box(sheet, -axis_y - 16, tall)
    body += Pos(-sheet / 2, 0, 0) * along_x(board / 2, sheet)
    return body + Pos((gap + stub_long - sheet) / 2, 0, 0) * along_x(stub / 2, gap + stub_long + sheet)


def board(wide, deep, board, stub, stub_long, play):
    body = Pos(0, board / 2 - deep / 2, 0) * Box(wide, deep, board)
    body = fillet(body.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 15)
    for x in (-1, 1):
        body -= Pos(x * wide / 2, 0, 0) * along_x(stub / 2 + play, 2 * stub_long + 2)
    return body


def gate(gate, gate_high, reach, bar=50):
    """Stands on z = 0, turns about z and points to -y; open in its middle."""
    outline = Pos(0, -reach / 2) * Rectangle(gate, reach) + Circle(gate / 2)
    body = extrude(outline, gate_high)
    hole = Pos(0, -bar - (reach - 2 * bar) / 2, bar) * Box(2 * gate, reach - 2 * bar, gate_high - 2 * bar, align=UP)
    body -= fillet(hole.edges().filter_by(Axis.X), 30)
    return chamfer(body.edges().filter_by(Axis.Z).group_by(Axis.Y)[0], 2)
