from build123d import Cylinder, fillet


def tyre(tyre_wide, link, across=80):
    """Turned about z, its middle at the origin."""
    disc = Cylinder(across / 2, tyre_wide)
    return fillet(disc.edges(), 2) - Cylinder(link / 2, 2 * tyre_wide)
