from build123d import Align, Box, Cylinder, Line, Pos, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    lift, th, hw, length = d["lift"], d["thickness"], d["half_width"], d["length"]
    outline = make_face([
        Line((0, -hw), (length, -hw)),
        Line((length, -hw), (length, hw)),
        Line((length, hw), (0, hw)),
        ThreePointArc((0, hw), (-hw, 0), (0, -hw)),
    ])
    mid = lift + th / 2
    arm = Pos(0, 0, mid) * extrude(outline, amount=th / 2, both=True)
    pin = Pos(0, 0, -d["pin_length"]) * Cylinder(
        d["pin_radius"], d["pin_length"] + mid, align=(Align.CENTER, Align.CENTER, Align.MIN))
    outer = d["slot_outer"]
    ring = Cylinder(outer, th + 2) - Cylinder(d["slot_inner"], th + 4)
    keep = Pos(0, d["slot_end"], 0) * Box(
        2 * outer + 2, 2 * outer + 2, th + 6, align=(Align.CENTER, Align.MAX, Align.CENTER))
    slot = Pos(0, 0, mid) * (ring & keep)
    return arm + pin - slot, {"pin": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
