from build123d import Box, Cylinder, Pos


def build(part):
    d = part.dimensions
    body = Box(2 * d.web, d.deep, d.high)
    tall = d.fork + 2 * d.plate
    for side in (-1, 1):
        body += Pos(side * (d.web + d.web_thick / 2)) * Box(d.web_thick, d.deep, tall)
        for up in (-1, 1):
            z = up * (d.fork + d.plate) / 2
            reach = d.hw - d.web
            body += Pos(side * (d.web + reach / 2), 0, z) * Box(reach, d.deep, d.plate)
            body += Pos(side * d.hw, 0, z) * Cylinder(d.boss, d.plate)
    return part.made(Pos(Z=d.zc) * body)
