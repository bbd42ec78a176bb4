from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, height, plate, plate_thickness, roof, roof_thickness = d["side"], d["height"], d["plate"], d["plate_thickness"], d["roof"], d["roof_thickness"]
    pivot_height, boss_diameter, boss, pin_diameter, pin = d["pivot_height"], d["boss_diameter"], d["boss"], d["pin_diameter"], d["pin"]
    shape = Box(plate, plate, plate_thickness, align=LOW) + Box(side, side, height, align=LOW) + Pos(0, 0, height) * Box(roof, roof, roof_thickness, align=LOW)
    shape += Pos(0, -side / 2, pivot_height) * Rot(X=90) * Cylinder(boss_diameter / 2, boss, align=LOW)
    shape += Pos(0, -side / 2 - boss, pivot_height) * Rot(X=90) * Cylinder(pin_diameter / 2, pin, align=LOW)
    return shape, {
        "pivot": {"o": (0, -side/2-boss, pivot_height), "z": (0, -1, 0), "x": (1, 0, 0)},
        "cap": {"o": (0, -side/2-boss-pin, pivot_height), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
