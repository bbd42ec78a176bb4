from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    diameter, thickness, face, drop, eye = d["diameter"], d["thickness"], d["face"], d["drop"], d["eye"]
    eye_width, bore = d["eye_width"], d["bore"]
    shape = Pos(face, 0, -drop) * Rot(Y=90) * Cylinder(diameter / 2, thickness, align=LOW)
    shape += Pos(face, 0, 0) * Box(thickness, eye_width, drop, align=(Align.MIN, Align.CENTER, Align.MAX))
    shape += Rot(X=90) * Cylinder(eye / 2, eye_width)
    shape -= Rot(X=90) * Cylinder(bore / 2, 2 * eye_width)
    return shape, {"body": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (1, 0, 0)}}
