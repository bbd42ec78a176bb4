from build123d import Align, Box, Cylinder, GridLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    side, thickness, pilot, motor_hole, motor_square = d["side"], d["thickness"], d["pilot"], d["motor_hole"], d["motor_square"]
    frame_hole, frame_square = d["frame_hole"], d["frame_square"]
    shape = Box(side, side, thickness, align=LOW) - Cylinder(pilot / 2, 3 * thickness)
    shape -= GridLocations(motor_square, motor_square, 2, 2) * Cylinder(motor_hole / 2, 3 * thickness)
    shape -= GridLocations(frame_square, frame_square, 2, 2) * Cylinder(frame_hole / 2, 3 * thickness)

    return shape, {}
