from build123d import Axis, BuildSketch, Circle, Locations, Mode, Plane, Pos, Rectangle, chamfer, extrude


def pintle(pin_d, eye_d, axis_to_plate, thick, wide=60, tall=120, below=60, boss=16, collar=2, pin_top=62, hole=7, inset_x=20, inset_z=48):
    front = Plane(origin=(0, axis_to_plate, tall / 2 - below), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    with BuildSketch(front) as face:
        Rectangle(wide, tall)
        with Locations(*[(x, z) for x in (-inset_x, inset_x) for z in (-inset_z, inset_z)]):
            Circle(hole / 2, mode=Mode.SUBTRACT)
    plate = extrude(face.sketch, -thick)
    with BuildSketch(Plane.XY) as arm:
        Circle(eye_d / 2)
        with Locations((0, (axis_to_plate + 1) / 2)):
            Rectangle(0.8 * eye_d, axis_to_plate + 1)
    bracket = Pos(0, 0, -collar) * extrude(arm.sketch, collar - boss) + extrude(Circle(0.4 * eye_d), -boss)
    pin = Pos(0, 0, -boss / 2) * extrude(Circle(pin_d / 2), pin_top + boss / 2)
    pin = chamfer(pin.edges().sort_by(Axis.Z)[-1], 1.5)
    return plate + bracket + pin
