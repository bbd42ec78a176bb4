from build123d import Align, BuildSketch, Circle, Cylinder, Locations, Mode, Pos, Rectangle, Rot, extrude


def strap(pin_d, clearance, eye_d, thick, length=300, wide=40, hole=9, first=100, pitch=80):
    r = eye_d / 2
    with BuildSketch() as profile:
        Circle(r)
        with Locations((0, -r)):
            Rectangle(length - r, thick, align=(Align.MIN, Align.MIN))
        Circle(pin_d / 2 + clearance, mode=Mode.SUBTRACT)
    bar = extrude(profile.sketch, wide)
    for number in range(3):
        bar -= Pos(first + number * pitch, -r + thick / 2, wide / 2) * Rot(X=90) * Cylinder(hole / 2, 2 * thick)
    return bar
