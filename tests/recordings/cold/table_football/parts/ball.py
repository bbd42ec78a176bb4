from build123d import Sphere


def build(part):
    r = part.dimensions["radius"]
    return Sphere(r), {"bottom": {"o": (0, 0, -r), "z": (0, 0, 1), "x": (1, 0, 0)}}
