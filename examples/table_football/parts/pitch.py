from build123d import Align, Box, Circle, Pos, Rectangle, extrude


def frame(length, width, line):
    return Rectangle(length, width) - Rectangle(length - 2 * line, width - 2 * line)


def build(part):
    d = part.dimensions
    length, width, line = d["length"], d["width"], d["line_width"]
    lines = Rectangle(line, width - 20) + frame(length - 20, width - 20, line)
    lines += Circle(d["circle_radius"]) - Circle(d["circle_radius"] - line)
    for side in (-1, 1):
        lines += Pos(side * (length - 20 - d["area_length"]) / 2, 0) * frame(d["area_length"], d["area_width"], line)
    board = Box(length, width, d["thickness"], align=(Align.CENTER, Align.CENTER, Align.MAX))
    board -= extrude(lines, -d["thickness"] / 5)
    return board, {"underside": {"o": (0, 0, -d["thickness"]), "z": (0, 0, 1), "x": (1, 0, 0)}}
