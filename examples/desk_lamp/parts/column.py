from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    play, tongue, top = d["play"], d["tongue"], d["axis_z"]
    foot = -d["bearing"] - 1.5 * play  # shoulder for the ring, one play below the bearing

    body = Pos(0, 0, foot) * Cylinder(d["shaft_radius"], top - d["neck_height"] - foot, align=LOW)
    body += Pos(0, 0, foot - d["spigot_length"]) * Cylinder(d["spigot_radius"], 2 * d["spigot_length"], align=LOW)
    body += Pos(0, 0, play / 2) * Cylinder(d["collar_radius"], d["collar_height"], align=LOW)
    body += Pos(0, 0, play / 2) * Cylinder(d["tube_radius"], top - d["neck_height"] - play / 2, align=LOW)

    along_y = Pos(0, -tongue / 2, top) * Rot(X=-90)
    body += Pos(0, 0, top) * Box(d["tongue_width"], tongue, d["neck_height"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    body += along_y * Cylinder(d["tongue_width"] / 2, tongue, align=LOW)
    body += along_y * Cylinder(d["pin_radius"], tongue + d["pin_length"], align=LOW)
    body += along_y * Cylinder(d["pin_spigot_radius"], tongue + d["pin_length"] + d["pin_spigot_length"], align=LOW)
    return body, {
        "shaft": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "ring": {"o": (0, 0, foot), "z": (0, 0, -1), "x": (1, 0, 0)},
        "shoulder": {"o": (0, tongue / 2 + play / 2, top), "z": (0, -1, 0), "x": (1, 0, 0)},
        "nut": {"o": (0, tongue / 2 + d["pin_length"], top), "z": (0, 1, 0), "x": (0, 0, 1)},
    }
