from build123d import Align, Axis, Cylinder, Pos, fillet

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def column(pin_d, pitch_r, link, rack_z, floor_z, shaft_d=13, wheel_d=110, wheel=8, tall=127.4):
    """Pinion at z = 0, its shaft down to the lower face of the plate, the steering wheel on top."""
    body = Pos(0, 0, floor_z - rack_z) * Cylinder(pin_d / 2, rack_z - floor_z + 1, align=UP)
    body += Cylinder(pitch_r, link, align=UP)
    body += Cylinder(shaft_d / 2, tall - rack_z - 1, align=UP)
    rim = Pos(0, 0, tall - rack_z - wheel) * Cylinder(wheel_d / 2, wheel, align=UP)
    return body + fillet(rim.edges().group_by(Axis.Z)[-1], 2)
