from build123d import Align, Box, Cylinder, Pos, Rot

X, Y = Rot(0, 90, 0), Rot(90, 0, 0)


def eye(thread_d, centre, hole_d, eye_d, eye_wide, window, into):
    body = Y * Cylinder(eye_d / 2, eye_wide)
    body += Pos(X=hole_d / 2 + 3) * X * Cylinder(thread_d / 2, centre - window / 2 + into - hole_d / 2 - 3, align=(Align.CENTER, Align.CENTER, Align.MIN))
    return body - Y * Cylinder(hole_d / 2, 2 * eye_wide)


def frame(thread_d, play, frame, window, wide=40, high=20, inside=24):
    body = Box(frame, wide, high) - Box(window, inside, 2 * high)
    return body - X * Cylinder(thread_d / 2 + play, 2 * frame)
