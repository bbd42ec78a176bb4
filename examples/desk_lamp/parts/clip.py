from build123d import Align, Cylinder


def build(part):
    d = part.dimensions
    down = (Align.CENTER, Align.CENTER, Align.MAX)
    ring = Cylinder(d["radius"], d["height"], align=down) - Cylinder(d["hole_radius"], d["height"], align=down)
    return ring, {"face": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)}}
