from build123d import Axis, Cylinder, Plane, Polygon, revolve


def build(part):
    d = part.dimensions
    end_diameter, middle_diameter, length, bore_diameter = d["end_diameter"], d["middle_diameter"], d["length"], d["bore_diameter"]
    outline = Polygon((0, 0), (end_diameter / 2, 0), (middle_diameter / 2, 0.4 * length), (middle_diameter / 2, 0.7 * length), (end_diameter / 2, length), (0, length), align=None)
    shape = revolve(Plane.XZ * outline, Axis.Z) - Cylinder(bore_diameter / 2, 4 * length)
    return shape, {
        "bore": {"o": (0, 0, -1), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
