from build123d import Align, Axis, Cylinder, Plane, Polygon, Pos, revolve

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    foot_diameter, waist_diameter, shoulder_diameter, neck_diameter, foot, waist = d["foot_diameter"], d["waist_diameter"], d["shoulder_diameter"], d["neck_diameter"], d["foot"], d["waist"]
    shoulder, neck, bore_diameter, bore_depth = d["shoulder"], d["neck"], d["bore_diameter"], d["bore_depth"]
    outline = Polygon((0, 0), (foot_diameter / 2, 0), (foot_diameter / 2, foot), (waist_diameter / 2, foot + 20), (waist_diameter / 2, waist),
                      (shoulder_diameter / 2, shoulder - 18), (shoulder_diameter / 2, shoulder), (neck_diameter / 2, shoulder + 4), (neck_diameter / 2, neck), (0, neck), align=None)
    shape = revolve(Plane.XZ * outline, Axis.Z)
    shape -= Pos(0, 0, neck) * Cylinder(bore_diameter / 2, bore_depth, align=HIGH)
    return shape, {
        "top": {"o": (0, 0, neck), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
