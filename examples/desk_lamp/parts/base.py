from build123d import Align, Axis, Cylinder, Pos, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    disc = Cylinder(d["radius"], d["height"], align=LOW)
    disc = chamfer(disc.edges().sort_by(Axis.Z)[-1], 0.4 * d["height"])
    hub = Cylinder(d["hub_radius"], d["hub_height"], align=LOW)
    hub = chamfer(hub.edges().sort_by(Axis.Z)[-1], 2)
    base = disc + hub
    for x, shaft, recess in ((0, d["column_radius"], d["column_recess_radius"]), (d["knob_x"], d["knob_radius"], d["knob_recess_radius"])):
        base -= Pos(x, 0, 0) * Cylinder(shaft + d["clearance"], 3 * d["hub_height"])
        base -= Pos(x, 0, 0) * Cylinder(recess, d["recess"], align=LOW)
    return base, {
        "column": {"o": (0, 0, d["hub_height"] + d["play"] / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
        "dimmer": {"o": (d["knob_x"], 0, d["height"] + d["play"] / 2), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
