from build123d import Align, Box, Cylinder, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    side, thickness, hole, pitch, rivet = d["side"], d["thickness"], d["hole"], d["pitch"], d["rivet"]
    shank, head, head_height = d["shank"], d["head"], d["head_height"]
    shape = Box(side, side, thickness, align=LOW) - GridLocations(pitch, pitch, 2, 2) * Cylinder(hole / 2, 4 * thickness)
    shape += Cylinder(rivet / 2, shank + head_height, align=HIGH) + Pos(0, 0, -shank) * Cylinder(head / 2, head_height, align=HIGH)
    return shape, {"fork": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
