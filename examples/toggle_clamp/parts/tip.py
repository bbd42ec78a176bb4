from build123d import Align, Cone, Cylinder

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    tip = Cone(d["bottom_radius"], d["top_radius"], d["height"], align=HIGH)
    return tip - Cylinder(d["hole_radius"], d["hole_depth"], align=HIGH), {"top": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
