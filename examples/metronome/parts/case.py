from math import atan2, degrees

from build123d import Align, Axis, Box, Cylinder, Pos, Rectangle, Rot, chamfer, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def frustum(width, z, top_width, top_z):
    taper = degrees(atan2((width - top_width) / 2, top_z - z))
    return Pos(0, 0, z) * extrude(Rectangle(width, width), top_z - z, taper=taper)


def build(part):
    d = part.dimensions
    height, wall, face, ledge = d["height"], d["wall"], d["face"], d["ledge"]
    foot = d["body_width"]
    plinth_width = foot + 2 * d["plinth_overhang"]

    body = frustum(foot, d["plinth_height"], d["top_width"], height)
    plinth = Box(plinth_width, plinth_width, d["plinth_height"], align=LOW)
    plinth = chamfer(plinth.edges().group_by(Axis.Z)[-1], 0.6 * d["plinth_overhang"])
    cavity = frustum(foot - 2 * wall, wall, d["top_width"] - 2 * wall, height - wall)

    # the front is cut away above the ledge and closed again by the ledge and the upright face
    front = Pos(0, -face, ledge) * Box(2 * foot, 2 * foot, height, align=(Align.CENTER, Align.MAX, Align.MIN))
    ledge_board = Pos(0, wall - face, ledge - wall) * Box(2 * foot, 2 * foot, wall, align=(Align.CENTER, Align.MAX, Align.MIN))
    face_board = Pos(0, -face, ledge - wall) * Box(2 * foot, wall, height, align=(Align.CENTER, Align.MIN, Align.MIN))
    shell = plinth + body - [cavity, front] + [ledge_board & body, face_board & body]

    # bearings
    bearing = Pos(d["key_inside"], 0, d["key_height"]) * Rot(Y=90)
    boss = bearing * Cylinder(d["boss_radius"], d["key_outside"] - d["key_inside"], align=LOW)
    key_bore = bearing * Cylinder(d["key_radius"] + d["clearance"], foot, align=LOW)
    arbor_bore = Pos(0, -face, d["pivot_height"]) * Rot(X=90) * Cylinder(d["arbor_radius"] + d["clearance"], 4 * wall)
    slot = Pos(0, d["slot_y"], ledge) * Box(d["slot_width"], d["slot_depth"], 4 * wall)
    feet = [(x, y) for x in (-d["foot_x"], d["foot_x"]) for y in (-d["foot_x"], d["foot_x"])]
    foot_holes = [Pos(x, y, 0) * Cylinder(d["foot_hole_radius"], d["foot_hole_depth"], align=LOW) for x, y in feet]
    shell = shell + boss - [key_bore, arbor_bore, slot, *foot_holes]

    # the two axes end half the axial play off their bearings
    connectors = {
        "pivot": {"o": (0, d["pivot_y"], d["pivot_height"]), "z": (0, -1, 0), "x": (0, 0, 1)},
        "key": {"o": (d["key_x"], 0, d["key_height"]), "z": (1, 0, 0), "x": (0, 0, 1)},
        "scale": {"o": (0, -face, ledge + 3), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
    for name, x, y in (("front_left", -1, -1), ("front_right", 1, -1), ("back_left", -1, 1), ("back_right", 1, 1)):
        connectors[f"foot_{name}"] = {"o": (x * d["foot_x"], y * d["foot_x"], 0), "z": (0, 0, 1), "x": (1, 0, 0)}
    return shell, connectors
