from build123d import Align, Box, fillet, Axis


def build(part):
    d = part.dimensions
    body = Box(d.wide, d.long, d.thick, align=(Align.CENTER, Align.MAX, Align.MIN))
    return part.made(fillet(body.edges().filter_by(Axis.Z), 0.05 * d.wide))
