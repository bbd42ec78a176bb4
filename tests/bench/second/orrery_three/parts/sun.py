from build123d import Align, Cylinder, Sphere


def sun(across=28, neck_d=6):
    return Sphere(across / 2) - Cylinder(neck_d / 2, across, align=(Align.CENTER, Align.CENTER, Align.MAX))
