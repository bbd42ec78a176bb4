from build123d import Align, Cone, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    foot_radius, top_radius, height, bore = d["foot_radius"], d["top_radius"], d["height"], d["bore"]
    shape = Cone(foot_radius, top_radius, height, align=LOW) - Cylinder(bore / 2, 3 * height)

    return shape, {"thread": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
