from build123d import Align, Cylinder, Plane, Pos, Rot, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thick, face = d["length"], d["width"], d["thickness"], d["play"] / 2
    outline = Pos(length / 2, 0) * SlotCenterToCenter(length, width)
    outline -= Pos(length / 2, 0) * SlotCenterToCenter(length - 3 * width, d["slot_width"])
    bar = extrude(Plane.XZ.offset(-face - thick) * outline, thick)  # Plane.XZ looks along -Y
    bar -= Rot(X=90) * Cylinder(d["pin_radius"] + d["clearance"], 4 * thick)

    elbow = Pos(length, face + thick / 2, 0) * Rot(X=90)
    reach = thick / 2 + d["pin_length"]
    bar += elbow * Cylinder(d["pin_radius"], reach, align=LOW)
    bar += elbow * Cylinder(d["spigot_radius"], reach + d["spigot_length"], align=LOW)
    return bar, {
        "shoulder": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "elbow": {"o": (length, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "nut": {"o": (length, face - d["pin_length"], 0), "z": (0, -1, 0)},
    }
