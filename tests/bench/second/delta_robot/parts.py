from build123d import Align, Axis, Box, Circle, Cylinder, Plane, PolarLocations, Pos, Rot, chamfer, extrude, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
ACROSS = Rot(X=90)  # turns z into the tangential direction


def base(shaft_r, shaft_d, play, cheek_in, cheek, hang, plate_r=106.5, plate=13, wide=16):
    """A round plate below z = hang; three pairs of cheeks bear the arms in z = 0."""
    body = Pos(0, 0, hang) * Cylinder(plate_r, plate, align=DOWN)
    body = chamfer(body.edges(), 1)
    side = Box(wide, cheek, hang - plate, align=UP) + ACROSS * Cylinder(wide / 2, cheek)
    side -= ACROSS * Cylinder(shaft_d / 2 + play, 4 * cheek)
    for place in PolarLocations(shaft_r, 3):
        for y in (-1, 1):
            body += place * Pos(0, y * (cheek_in + cheek / 2), 0) * side
    return body


def _prongs(eye, gap, prong, tall, pin_d, play):
    """Two eyes about the tangential axis through the origin, on prongs upwards."""
    leg = Box(2 * eye, prong, tall, align=UP) + ACROSS * Cylinder(eye, prong)
    leg -= ACROSS * Cylinder(pin_d / 2 + play, 4 * prong)
    return [Pos(0, y * (gap + prong / 2), 0) * leg for y in (-1, 1)]


def platform(joint_r, eye, gap, prong, pin_d, play, below=30.93, plate_r=49, plate=5):
    body = Pos(0, 0, -below) * Cylinder(plate_r, plate, align=UP)
    body = chamfer(body.edges(), 0.5)
    for place in PolarLocations(joint_r, 3):
        for leg in _prongs(eye, gap, prong, below - plate + 1, pin_d, play):
            body += place * Rot(X=180) * leg
    return body


def arm(arm, rest_deg, shaft_d, cheek_in, cheek, bar, bar_low, bar_high, eye, gap, prong, pin_d, play, nose=7.1):
    """Shaft at the origin; a bar that runs above the line to the elbow, from which two prongs reach down to it."""
    thick, middle = (bar_high - bar_low) / 2, (bar_low + bar_high) / 2
    figure = make_hull([*Circle(6).edges(), *(Pos(arm, middle) * Circle(thick)).edges()])
    body = extrude(Plane.XZ * figure, bar / 2, both=True)
    body += Pos(arm + (nose - eye) / 2, 0, middle) * Box(nose + eye, bar, 2 * thick)
    body += Pos(arm + nose, 0, middle) * Cylinder(bar / 2, 2 * thick)
    body += Pos(arm, 0, middle) * Box(2 * eye, 2 * (gap + prong), 2 * thick)
    for leg in _prongs(eye, gap, prong, bar_low + 1, pin_d, play):
        body += Pos(arm, 0, 0) * leg
    body += ACROSS * Cylinder(shaft_d / 2, 2 * (cheek_in + cheek))
    return Rot(Y=rest_deg) * body


def forearm(forearm, eye, gap, prong, pin_d, play, window=13.5, bridge=4, rod=8):
    """From the elbow at the origin along -x, a fork at either end whose eyes lie about z."""
    body = Pos(-forearm / 2, 0, 0) * Rot(Y=90) * Cylinder(rod / 2, forearm - 2 * window - bridge)
    for x, way in ((0, -1), (-forearm, 1)):
        leg = Box(window + bridge, 2 * eye, prong, align=(Align.MIN, Align.CENTER, Align.CENTER)) + Cylinder(eye, prong)
        for z in (-1, 1):
            body += Pos(x, 0, z * (gap + prong / 2)) * Rot(Z=0 if way > 0 else 180) * leg
        body += Pos(x + way * (window + bridge / 2), 0, 0) * Box(bridge, 2 * eye, 2 * (gap + prong))
        body -= Pos(x, 0, 0) * Cylinder(pin_d / 2 + play, 4 * gap)
    return body


def cross(pin_d, gap, prong, hub=8, air=0.3):
    """Pins about y and z, with shoulders that keep the forks apart."""
    body = None
    for turn in (Rot(), ACROSS):
        pin = Cylinder(pin_d / 2, 2 * (gap + prong))
        pin = turn * (chamfer(pin.edges(), 0.5) + Cylinder(hub / 2, 2 * (gap - air)))
        body = pin if body is None else body + pin
    return body
