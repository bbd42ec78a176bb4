from build123d import Align, Circle, Cylinder, Plane, Pos, Rectangle, Rot, SlotCenterToCenter, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
FORWARD, BACK = Rot(X=90), Rot(X=-90)  # turn +Z to -Y and to +Y


def build(part):
    d = part.dimensions
    radius, play, spigot = d["radius"], d["play"], d["spigot_length"]
    back = d["bearing"] + 1.5 * play  # shoulder behind the wall
    front = d["web"] + d["rod_thickness"] + 2.5 * play  # shoulder before the rod

    outline = Pos(0, radius / 2) * SlotCenterToCenter(radius, d["arm_width"], rotation=90)
    half = Rectangle(4 * radius, 2 * radius, align=(Align.CENTER, Align.MAX))
    outline += Circle(d["counter_radius"]) & half
    crank = Pos(0, -play / 2, 0) * extrude(Plane.XZ * outline, d["web"])  # Plane.XZ looks along -Y

    crank += Pos(0, -d["web"], 0) * BACK * Cylinder(d["shaft_radius"], d["web"] + back, align=LOW)
    crank += BACK * Cylinder(d["spigot_radius"], back + spigot, align=LOW)
    crank += Pos(0, -play, radius) * FORWARD * Cylinder(d["pin_radius"], front - play, align=LOW)
    crank += Pos(0, -play, radius) * FORWARD * Cylinder(d["spigot_radius"], front - play + spigot, align=LOW)
    return crank, {
        "shaft": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
        "pin": {"o": (0, -d["web"] - play, radius), "z": (0, -1, 0), "x": (0, 0, 1)},
        "flywheel": {"o": (0, back, 0), "z": (0, 1, 0), "x": (0, 0, 1)},
        "cap": {"o": (0, -front, radius), "z": (0, -1, 0), "x": (0, 0, 1)},
    }
