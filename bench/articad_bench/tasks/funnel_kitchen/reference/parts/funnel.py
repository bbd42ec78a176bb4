from build123d import Align, Cone, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    rim, spout, cone, spout_length, sheet = d["rim"], d["spout"], d["cone"], d["spout_length"], d["sheet"]
    lip = d["lip"]
    shape = Cylinder(spout / 2, spout_length, align=LOW) + Pos(0, 0, spout_length) * Cone(spout / 2, rim / 2, cone, align=LOW)
    shape += Pos(0, 0, spout_length + cone) * Cylinder(rim / 2 + lip, sheet, align=HIGH)
    shape -= Cylinder(spout / 2 - sheet, 3 * spout_length) + Pos(0, 0, spout_length) * Cone(spout / 2 - sheet, rim / 2 - sheet, cone, align=LOW)
    return shape, {}
