from build123d import Align, Box, Cylinder, Pos, Rot


def build(part):
    d = part.dimensions
    length, thick = d["length"], 2 * d["half_thickness"]
    body = Box(length, thick, 2 * d["bar_half"], align=(Align.MIN, Align.CENTER, Align.CENTER))
    eye = Rot(X=90) * Cylinder(d["eye_radius"], thick)
    bore = Rot(X=90) * Cylinder(d["bore_radius"], thick + 2)
    body = body + eye + Pos(length, 0, 0) * eye
    body = body - bore - Pos(length, 0, 0) * bore
    c = part.connectors
    return body, {
        "rear": {"o": (0, 0, 0), "z": (0, 1, 0), "x": c["rear"].x},
        "front": {"o": (length, 0, 0), "z": (0, -1, 0), "x": c["front"].x},
    }
