from build123d import Align, Cylinder, Sphere


def globe(earth_d, post_d):
    return Sphere(earth_d / 2) - Cylinder(post_d / 2, earth_d, align=(Align.CENTER, Align.CENTER, Align.MAX))
