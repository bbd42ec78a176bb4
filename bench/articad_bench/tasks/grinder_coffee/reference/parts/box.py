from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FRONT = (Align.CENTER, Align.MIN, Align.MIN)


def build(part):
    d = part.dimensions
    top = d["box_height"] + d["hopper_height"]
    body = Box(d["side"], d["side"], d["box_height"], align=LOW) + Pos(0, 0, d["box_height"]) * Cylinder(
        d["hopper_radius"], d["hopper_height"], align=LOW
    )
    body -= Pos(0, -d["side"] / 2, d["drawer_z"] - d["play"]) * Box(
        d["drawer_width"] + 2 * d["play"], d["drawer_depth"] + 2, d["drawer_height"] + 2 * d["play"], align=FRONT
    )
    body -= Pos(0, 0, d["box_height"] - 10) * Cylinder(d["hopper_radius"] - 3, d["hopper_height"] + 7, align=LOW)
    body -= Pos(0, 0, d["drawer_z"] + d["drawer_height"] + 20) * Cylinder(d["shaft_radius"] + d["clearance"], 200, align=LOW)
    body -= Pos(0, -22, top) * Cylinder(9, 20)
    body += Pos(24, -12, top - 1) * Cylinder(d["pin_radius"], 5, align=LOW)

    return body, {
        "drawer": {"o": (0, -d["side"] / 2, d["drawer_z"]), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cover": {"o": (24, -12, d["box_height"] + d["hopper_height"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "crank": {"o": (0, 0, d["box_height"] + d["hopper_height"]), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
