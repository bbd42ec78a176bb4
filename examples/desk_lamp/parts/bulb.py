from build123d import Align, Cylinder, Pos, Sphere


def build(part):
    d = part.dimensions
    holder = Cylinder(d["holder_radius"], d["holder_height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    return holder + Pos(0, 0, d["globe_z"]) * Sphere(d["globe_radius"]), {"foot": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
