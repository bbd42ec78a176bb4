from build123d import Pos, Torus


def build(part):
    d = part.dimensions
    body = Pos(-d["ring_major"], 0, 0) * Torus(d["ring_major"], d["ring_minor"])
    return body, {"ring": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}}
