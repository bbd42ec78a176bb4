from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    ceiling, thick = d["plate_gap"], d["plate_thickness"]
    length, width = d["right"] - d["left"], 2 * (d["lug_y"] + d["margin"])
    deck = Pos(d["left"], 0, ceiling) * Box(length, width, thick + d["rim_height"], align=CORNER)
    deck -= Pos(d["left"] + thick, 0, ceiling + thick) * Box(length - 2 * thick, width - 2 * thick, 2 * d["rim_height"], align=CORNER)

    lug = Rot(X=90) * Cylinder(d["lug_width"] / 2, d["lug_thickness"])
    lug += Box(d["lug_width"], d["lug_thickness"], ceiling, align=LOW)

    deck += Pos(0, 0, ceiling) * Box(d["lug_width"] / 2, 2 * d["lug_y"], d["lug_width"] / 2, align=HIGH)  # tie

    start, end, size = d["rail_start"], d["rail_end"], d["rail_size"]
    rail = Pos((start + end) / 2, 0, d["rail_z"]) * Box(end - start + d["post_length"], size, size)
    for x in (start - d["post_length"] / 2, end + d["post_length"] / 2):
        rail += Pos(x, 0, ceiling) * Box(d["post_length"], d["post_width"], ceiling - d["rail_z"] + size, align=HIGH)
    deck += Pos((start + end) / 2, 0, ceiling) * Box(end - start, 2 * d["rail_y"], thick / 2, align=HIGH)  # stiffens the deck
    for side in (-1, 1):
        deck += Pos(0, side * (d["lug_y"] + d["lug_thickness"] / 2), 0) * lug
        deck += Pos(0, side * (d["lug_y"] - d["pin_length"]), 0) * Rot(X=-90 * side) * Cylinder(d["pin_radius"], d["pin_length"], align=LOW)
        deck += Pos(0, side * d["rail_y"], 0) * rail
    return deck, {
        "pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "rails": {"o": (0, 0, d["rail_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
