from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    eye, eye_width, eye_bore, outside, back = d["eye"], d["eye_width"], d["eye_bore"], d["outside"], d["back"]
    front, bore, wall, rod_bore = d["front"], d["bore"], d["wall"], d["rod_bore"]
    shape = Rot(X=90) * Cylinder(eye / 2, eye_width) + Pos(back / 2 + 4, 0, 0) * Box(back, eye_width, 0.8 * eye)
    shape += Pos(back, 0, 0) * Rot(Y=90) * Cylinder(outside / 2, front - back, align=LOW)
    shape -= Pos(back + wall, 0, 0) * Rot(Y=90) * Cylinder(bore / 2, front - back - 2 * wall, align=LOW)
    shape -= Pos(front, 0, 0) * Rot(Y=90) * Cylinder(rod_bore / 2, 3 * wall)
    shape -= Rot(X=90) * Cylinder(eye_bore / 2, 2 * eye_width)
    return shape, {"bracket": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)}, "rod": {"o": (front, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
