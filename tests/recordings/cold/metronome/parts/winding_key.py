from build123d import Align, Cylinder, Plane, Pos, RectangleRounded, Rot, extrude


def build(part):
    d = part.dimensions
    inner, start, length = d["shaft_inner"], d["wing_start"], d["wing_length"]
    shaft = Pos(-inner, 0, 0) * Rot(Y=90) * Cylinder(
        d["shaft_radius"], inner + start + length / 2, align=(Align.CENTER, Align.CENTER, Align.MIN))
    outline = Plane.XZ * RectangleRounded(length, 2 * d["wing_half"], d["corner_radius"])
    wing = Pos(start + length / 2, 0, 0) * extrude(outline, amount=d["wing_thickness"] / 2, both=True)
    return wing + shaft, {"shaft": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 0, 1)}}
