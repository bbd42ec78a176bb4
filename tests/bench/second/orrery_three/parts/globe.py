from build123d import Align, Box, Pos, Sphere


def globe(earth_d, globe_low):
    """A ball with a flat below, on which it is glued."""
    return Sphere(earth_d / 2) - Pos(0, 0, -globe_low) * Box(earth_d, earth_d, earth_d, align=(Align.CENTER, Align.CENTER, Align.MAX))
