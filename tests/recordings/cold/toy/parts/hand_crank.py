from build123d import Align, Cylinder, Plane, Pos, Rot, SlotOverall, extrude


def build(part):
    d = part.dimensions
    t, reach, r = d["thickness"], d["reach"], d["end_radius"]
    slot = Pos(reach / 2, 0, 0) * SlotOverall(reach + 2 * r, 2 * r)
    arm = extrude(Plane.YZ * slot, amount=t)
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    inside = t / 2  # the knob pin is rooted in the arm
    pin = Pos(inside, reach, 0) * Rot(Y=90) * Cylinder(d["pin_radius"], d["pin_end"] - inside, align=low)
    head = Pos(d["head_x"], reach, 0) * Rot(Y=90) * Cylinder(
        d["head_radius"], d["pin_end"] - d["head_x"], align=low)
    shape = arm + pin + head
    shape = shape - Pos(t / 2, 0, 0) * Rot(Y=90) * Cylinder(d["hole_radius"], t + 2)
    return shape, {
        "socket": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "knob_pin": {"o": (d["knob_x"], reach, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
