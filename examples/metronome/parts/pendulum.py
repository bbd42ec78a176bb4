from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
BACK = Rot(X=-90)  # turns +Z to +Y


def build(part):
    d = part.dimensions
    width, thick, hub = d["rod_width"], d["rod_thickness"], d["hub_length"]
    middle = -hub - thick / 2  # the rod's middle plane

    rod = Pos(0, middle, -d["tail"]) * Box(width, thick, d["reach"] + d["tail"], align=LOW)
    pitch = (d["reach"] - d["weight_low"]) / (d["notch_count"] + 1)
    notch = Rot(Y=45) * Box(1, 2 * thick, 1)
    rod -= [Pos(width / 2, middle, d["weight_low"] + (i + 1) * pitch) * notch for i in range(d["notch_count"])]

    bob = Pos(0, middle - d["bob_thickness"] / 2, -d["tail"]) * BACK * Cylinder(d["bob_radius"], d["bob_thickness"], align=LOW)
    boss = Pos(0, -hub - thick, 0) * BACK * Cylinder(d["hub_radius"], hub + thick, align=LOW)
    arbor = Pos(0, -hub, 0) * BACK * Cylinder(d["arbor_radius"], hub + d["arbor_length"], align=LOW)
    spigot = BACK * Cylinder(d["spigot_radius"], d["arbor_length"] + d["spigot_length"], align=LOW)
    return rod + bob + boss + arbor + spigot, {
        "pivot": {"o": (0, d["play"] / 2, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
        "rod": {"o": (0, middle, d["weight_low"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "nut": {"o": (0, d["arbor_length"], 0), "z": (0, 1, 0), "x": (1, 0, 0)},
    }
