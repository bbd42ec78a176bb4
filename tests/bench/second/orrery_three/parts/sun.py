from build123d import Align, Box, Pos, Sphere


def sun(sun_d, sun_low):
    """A ball with a flat below, on which it is glued."""
    return Sphere(sun_d / 2) - Pos(0, 0, -sun_low) * Box(sun_d, sun_d, sun_d, align=(Align.CENTER, Align.CENTER, Align.MAX))
