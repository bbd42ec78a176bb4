from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    hub, height, gap, pin, pin_length = d["hub"], d["height"], d["gap"], d["pin"], d["pin_length"]
    arm, reach, arm_deg = d["arm"], d["reach"], d["arm_deg"]
    shape = Pos(0, 0, gap) * (Cylinder(hub / 2, height, align=LOW) + Cylinder(pin / 2, pin_length, align=HIGH))
    shape += Pos(0, 0, height / 2) * Rot(X=arm_deg - 90) * Cylinder(arm / 2, reach, align=LOW)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
