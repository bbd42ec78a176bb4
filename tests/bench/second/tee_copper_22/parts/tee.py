from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def tee(socket, wall, reach, socket_deep=18, bore=20):
    """Three equal arms about the origin, along x, -x and z; each is bored to the middle and its socket turned out."""
    arms = [Rot(Y=turn) for turn in (90, -90, 0)]
    pipe = Cylinder(socket / 2 + wall, reach, align=UP)
    body = arms[0] * pipe + arms[1] * pipe + arms[2] * pipe
    for arm in arms:
        body -= arm * Cylinder(bore / 2, reach, align=UP)
        body -= arm * Pos(0, 0, reach - socket_deep) * Cylinder(socket / 2, socket_deep, align=UP)
    return body
