from build123d import Box, Pos


def build(part):
    d = part.dimensions
    return part.made(Pos(Z=d.high / 2) * Box(d.wide, d.wide, d.high))
