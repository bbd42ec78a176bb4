from build123d import Align, Box, Cylinder, Pos, Rot

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
LOW = (Align.CENTER, Align.CENTER, Align.MIN)
CORNER = (Align.MIN, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    floor, length = -d["plate_gap"], d["right"] - d["left"]
    base = Pos(d["left"], 0, floor) * Box(length, 2 * (d["rail_y"] + d["margin"]), d["plate_thickness"], align=CORNER)

    lug = Rot(X=90) * Cylinder(d["lug_width"] / 2, d["lug_thickness"])
    lug += Box(d["lug_width"], d["lug_thickness"], -floor, align=HIGH)
    lug -= Rot(X=90) * Cylinder(d["bore_radius"], 2 * d["lug_thickness"])

    base += Pos(0, 0, floor) * Box(d["lug_width"] / 2, 2 * d["lug_y"], d["lug_width"] / 2, align=LOW)  # tie

    start, end, size = d["rail_start"], d["rail_end"], d["rail_size"]
    rail = Pos((start + end) / 2, 0, -d["rail_z"]) * Box(end - start + d["post_length"], size, size)
    for x in (start - d["post_length"] / 2, end + d["post_length"] / 2):
        rail += Pos(x, 0, floor) * Box(d["post_length"], d["post_width"], -floor - d["rail_z"] + size, align=LOW)
    for side in (-1, 1):
        base += Pos(0, side * (d["lug_y"] + d["lug_thickness"] / 2), 0) * lug
        base += Pos(0, side * d["rail_y"], 0) * rail
    return base, {
        "pivot": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)},
        "rails": {"o": (0, 0, -d["rail_z"]), "z": (1, 0, 0), "x": (0, 0, 1)},
    }
