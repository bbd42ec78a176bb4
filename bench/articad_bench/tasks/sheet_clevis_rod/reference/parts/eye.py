from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    eye_diameter, thickness, bore_diameter, shank_diameter, shank_end, end_diameter = d["eye_diameter"], d["thickness"], d["bore_diameter"], d["shank_diameter"], d["shank_end"], d["end_diameter"]
    end_length, cross_hole_diameter, cross_hole_x = d["end_length"], d["cross_hole_diameter"], d["cross_hole_x"]
    shape = Cylinder(eye_diameter / 2, thickness) + Rot(Y=90) * Cylinder(shank_diameter / 2, shank_end - end_length, align=LOW)
    shape += Rot(Y=90) * Cylinder(end_diameter / 2, shank_end, align=LOW)
    shape -= Cylinder(bore_diameter / 2, 2 * eye_diameter)
    shape -= Pos(cross_hole_x, 0, 0) * Rot(X=90) * Cylinder(cross_hole_diameter / 2, 2 * end_diameter)
    return shape, {
        "axis": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
