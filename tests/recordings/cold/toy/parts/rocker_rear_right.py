from build123d import Align, Cylinder, Plane, Pos, Rot, SlotOverall, extrude


def build(part):
    d = part.dimensions
    t, length, r = d["thickness"], d["length"], d["eye_radius"]
    slot = Pos(length / 2, 0, 0) * SlotOverall(length + 2 * r, 2 * r)
    link = extrude(Plane.YZ * slot, amount=t)
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    inside = t / 2  # the pin is rooted in the link
    pin = Pos(inside, length, 0) * Rot(Y=90) * Cylinder(d["pin_radius"], d["pin_end"] - inside, align=low)
    shape = link + pin
    shape = shape - Pos(t / 2, 0, 0) * Rot(Y=90) * Cylinder(d["bore_radius"], t + 2)
    return shape, {
        "pivot": {"o": (t, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "leg_pin": {"o": (d["pin_end"], length, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
