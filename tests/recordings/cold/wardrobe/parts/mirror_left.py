from build123d import Align, Box


def build(part):
    d = part.dimensions
    sheet = Box(d["width"], d["thickness"], d["height"],
                align=(Align.CENTER, Align.MAX, Align.CENTER))
    return sheet, {"back": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
