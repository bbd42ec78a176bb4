"""Parts of the bridge crane; side 1 lies toward +y (for the small wheels +x), -1 opposite; flanges are on the inside."""

from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def along_x(diameter, long):
    return Rot(0, 90, 0) * Cylinder(diameter / 2, long)


def along_y(diameter, long):
    return Rot(90, 0, 0) * Cylinder(diameter / 2, long)


def beam(beam_long, beam_wide, beam_high, wall=8):
    """Box section along x."""
    body = Box(beam_long, beam_wide, beam_high, align=UP)
    return body - Pos(0, 0, wall) * Box(2 * beam_long, beam_wide - 2 * wall, beam_high - 2 * wall, align=UP)


def column(column, column_high, wall=6):
    """Square tube with a plate on its head."""
    body = Box(column, column, column_high, align=UP)
    return body - Pos(0, 0, -wall) * Box(column - 2 * wall, column - 2 * wall, column_high, align=UP)


def tie(tie_long, column, wall=6):
    """Square tube along y, below z = 0."""
    body = Box(column, tie_long, column, align=DOWN)
    return body - Pos(0, 0, -wall) * Box(column - 2 * wall, 2 * tie_long, column - 2 * wall, align=DOWN)


def rail(rail_long, rail_wide, rail_high):
    return Box(rail_long, rail_wide, rail_high, align=UP)


def stop(stop_thick, stop_wide, stop_high):
    return Box(stop_thick, stop_wide, stop_high, align=UP)


def buffer(side, buffer_d, buffer_long):
    """From the stop's face, x = 0, inwards."""
    return Pos(-side * buffer_long / 2, 0, 0) * along_x(buffer_d, buffer_long)


def truck(side, truck_long, truck_wide, truck_high, truck_air, tread, rim, wheel_wide, flange, axle_d, axle_apart, slack=2, top=10):
    """Block about the axles' height, with a pocket open below for each wheel."""
    low = truck_air - tread / 2
    body = Pos(0, 0, low) * Box(truck_long, truck_wide, truck_high, align=UP)
    for end in (-1, 1):
        at = Pos(end * axle_apart / 2, -side * flange / 2, low + truck_high - top)
        body -= at * Box(rim + 10, wheel_wide + 2 * slack, 2 * truck_high, align=DOWN)
        body -= Pos(end * axle_apart / 2, 0, 0) * along_y(axle_d, 2 * truck_wide)
    return body


def girder(girder_long, girder_wide, girder_high, wall=6):
    body = Box(girder_wide, girder_long, girder_high, align=UP)
    return body - Pos(0, 0, wall) * Box(girder_wide - 2 * wall, 2 * girder_long, girder_high - 2 * wall, align=UP)


def track(track_wide, track_long, track_high):
    return Box(track_wide, track_long, track_high, align=UP)


def axle(axle_d, axle_long):
    return along_y(axle_d, axle_long)


def wheel(side, tread, rim, wheel_wide, flange, axle_d, play):
    """The middle of the tread lies in y = 0."""
    wide = wheel_wide - flange
    body = along_y(tread, wide) + Pos(0, -side * wheel_wide / 2, 0) * along_y(rim, flange)
    return body - along_y(axle_d + play, 3 * wheel_wide)


def stub(small_axle, small_long):
    return along_x(small_axle, small_long)


def roller(side, small_tread, small_rim, small_wide, flange, small_axle, play):
    """The middle of the tread lies in x = 0."""
    wide = small_wide - flange
    body = along_x(small_tread, wide) + Pos(-side * small_wide / 2, 0, 0) * along_x(small_rim, flange)
    return body - along_x(small_axle + play, 3 * small_wide)


def trolley(
    frame_wide,
    frame_long,
    frame_high,
    frame_air,
    girder_apart,
    small_tread,
    small_rim,
    small_wide,
    small_axle,
    small_long,
    small_apart,
    flange,
    mast,
    slack=2,
):
    """Frame about the axles' height: two sides with pockets, two ends and a bridge with a hole for the mast."""
    low = frame_air - small_tread / 2
    body = Pos(0, 0, low) * Box(frame_wide, frame_long, frame_high, align=UP)
    inner = girder_apart - small_long
    for end in (-1, 1):
        body -= Pos(0, end * (frame_long / 4 + 15), 0) * Box(inner, frame_long / 2 - 130, 4 * frame_high)
    body -= Box(mast + 10, mast + 10, 4 * frame_high)
    for x in (-1, 1):
        for y in (-1, 1):
            at = Pos(x * (girder_apart - flange) / 2, y * small_apart / 2, 0)
            body -= at * Box(small_wide + 2 * slack, small_rim + 10, 4 * frame_high)
            outward = Pos(x * (inner + frame_wide) / 4, y * small_apart / 2, 0)
            body -= outward * along_x(small_axle, (frame_wide - inner) / 2 + 2)
    return body


def sleeve(sleeve, sleeve_high, mast, guide):
    return Box(sleeve, sleeve, sleeve_high, align=UP) - Box(mast + 2 * guide, mast + 2 * guide, 3 * sleeve_high)


def mast(mast, mast_long, foot, stem_d, play, wall=8):
    """Square tube with a thick foot, bored for the stem."""
    body = Box(mast, mast, mast_long, align=UP)
    body -= Pos(0, 0, foot) * Box(mast - 2 * wall, mast - 2 * wall, mast_long, align=UP)
    return body - Cylinder((stem_d + play) / 2, 4 * foot)


def hook(stem_d, plate_wide, plate_high, foot, nut_high, air, thick=30, eye=36):
    """Plate below z = 0 with an eye for the load, its stem above."""
    body = Pos(0, 0, -air) * Box(plate_wide, thick, plate_high, align=DOWN)
    body -= Pos(0, 0, -plate_high + eye) * along_y(eye, 2 * thick)
    return body + Pos(0, 0, -air - 1) * Cylinder(stem_d / 2, foot + nut_high + 2 * air + 6, align=UP)


def hook_nut(stem_d, nut_high, wide=50):
    return Cylinder(wide / 2, nut_high, align=UP) - Cylinder(stem_d / 2, 4 * nut_high)
