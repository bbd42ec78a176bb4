from build123d import Align, Circle, Cylinder, Plane, Pos, Rectangle, Rot, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
ALONG_X = Rot(Y=90)  # turns +Z to +X


def build(part):
    d = part.dimensions
    spigot_end = d["shaft_length"] + d["spigot_length"]
    shaft = Pos(-d["shaft_length"], 0, 0) * ALONG_X * Cylinder(d["shaft_radius"], d["shaft_length"] + d["collar_length"], align=LOW)
    spigot = Pos(-spigot_end, 0, 0) * ALONG_X * Cylinder(d["spigot_radius"], spigot_end, align=LOW)
    collar = ALONG_X * Cylinder(d["collar_radius"], d["collar_length"], align=LOW)

    ears = Rectangle(d["ear_x"], 2 * d["shaft_radius"], align=(Align.MIN, Align.CENTER))
    for side in (-1, 1):
        ears += Pos(d["ear_x"], side * d["ear_offset"]) * Circle(d["ear_radius"])
    for side in (-1, 1):
        ears -= Pos(d["ear_x"], side * d["ear_offset"]) * Circle(d["hole_radius"])
    butterfly = extrude(Plane.XZ * ears, d["thickness"] / 2, both=True)

    return shaft + spigot + collar + butterfly, {
        "shaft": {"o": (-d["play"] / 2, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)},
        "barrel": {"o": (-d["shaft_length"], 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)},
    }
