from build123d import Axis, Plane, Polyline, make_face, revolve


def grip(pin, play, grip_long, low=18, belly=26, high=16, belly_low=13.6, belly_high=25):
    bore = pin / 2 + play
    outline = [(bore, 0), (low / 2, 0), (belly / 2, belly_low), (belly / 2, belly_high), (high / 2, grip_long), (bore, grip_long), (bore, 0)]
    return revolve(Plane.XZ * make_face(Polyline(*outline)), Axis.Z)
