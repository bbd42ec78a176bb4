from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.MIN, Align.MIN)
FRONT = Rot(X=90)  # drawn in x and y as seen from the front, layers upwards; then stood up


def build(part):
    d = part.dimensions
    shape = Pos(-d["depth"] / 2, d["floor"], -d["play"] - d["deep"]) * Box(d["depth"], d["height"] - d["floor"] - 20, d["deep"], align=CORNER)
    shape -= Pos(-d["depth"] / 2 + d["wall"], d["floor"] + d["wall"], -d["play"] - d["deep"] + d["wall"]) * Box(d["depth"] - 2 * d["wall"], 2 * d["height"], d["deep"] - 2 * d["wall"], align=CORNER)
    shape += Pos(-d["depth"] / 2, d["height"] - 30, -d["play"] - d["board"]) * Box(36, 34, d["board"], align=CORNER)
    shape += Pos(0, 0, -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["o_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    shape += Pos(d["h_u"], d["h_v"], -d["play"] - d["board"] / 2) * Cylinder(d["pin_r"], d["h_high"] - (-d["play"] - d["board"] / 2), align=LOW)
    return FRONT * shape, {
        "o": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "h": {"o": (d["h_u"], 0, d["h_v"]), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
