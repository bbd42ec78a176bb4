from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, thickness, gap, hub, hub_length = d["diameter"], d["thickness"], d["gap"], d["hub"], d["hub_length"]
    journal, journal_length, screw, reach, handle = d["journal"], d["journal_length"], d["screw"], d["reach"], d["handle"]
    handle_length, handle_at = d["handle_length"], d["handle_at"]
    shape = Pos(0, 0, gap) * Cylinder(hub / 2, hub_length, align=LOW) + Pos(0, 0, gap + hub_length) * Cylinder(diameter / 2, thickness, align=LOW)
    shape += Pos(handle_at, 0, gap + hub_length + thickness) * Cylinder(handle / 2, handle_length, align=LOW)
    shape += Pos(0, 0, gap) * (Cylinder(journal / 2, journal_length, align=HIGH) + Cylinder(screw / 2, reach, align=HIGH))
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
