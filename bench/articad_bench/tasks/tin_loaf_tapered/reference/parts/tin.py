from build123d import Align, Box, Pos, Rectangle, loft

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width, height, smaller, sheet = d["length"], d["width"], d["height"], d["smaller"], d["sheet"]
    lip = d["lip"]
    outside = loft([Rectangle(length - smaller, width - smaller), Pos(0, 0, height) * Rectangle(length, width)])
    thin = 2 * sheet
    low = smaller * (1 - sheet / height)
    inside = loft([Pos(0, 0, sheet) * Rectangle(length - low - thin, width - low - thin), Pos(0, 0, height) * Rectangle(length - thin, width - thin)])
    shape = outside + Pos(0, 0, height) * Box(length + 2 * lip, width + 2 * lip, sheet, align=HIGH) - inside
    return shape, {}
