from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, reach, socket, socket_depth, bore = d["length"], d["reach"], d["socket"], d["socket_depth"], d["bore"]
    wall = d["wall"]
    outside = socket / 2 + wall
    shape = Rot(Y=90) * Cylinder(outside, length) + Cylinder(outside, reach, align=LOW)
    shape -= Rot(Y=90) * Cylinder(bore / 2, 2 * length) + Cylinder(bore / 2, 2 * reach, align=LOW)
    for end in (Pos(length / 2, 0, 0) * Rot(Y=90), Pos(-length / 2, 0, 0) * Rot(Y=-90), Pos(0, 0, reach)):
        shape -= end * Cylinder(socket / 2, socket_depth, align=HIGH)
    return shape, {}
