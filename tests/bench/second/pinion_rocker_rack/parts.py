from math import acos, cos, pi, radians, sin, tan

from build123d import Align, Axis, Box, Circle, Cylinder, Polygon, Pos, Rot, chamfer, extrude, fillet, make_hull

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)
PRESSURE = radians(20)
THIN = 0.16  # taken off each tooth at the pitch circle
TALL, DEEP = 0.9, 1.25  # of the module


def _wheel(module, count, turned=0.0):
    """Outline of an involute wheel; a tooth points to +x, turned by so many radians."""
    pitch_r = module * count / 2
    base_r, tip_r, root_r = pitch_r * cos(PRESSURE), pitch_r + TALL * module, pitch_r - DEEP * module
    half = (pi * module / 2 - THIN) / 2 / pitch_r + tan(PRESSURE) - PRESSURE  # half a tooth on the base circle

    def angle(r):
        roll = acos(base_r / r)
        return half - (tan(roll) - roll)

    start = max(base_r, root_r)
    flank = [(r, angle(r)) for r in (start + (tip_r - start) * i / 5 for i in range(6))]
    if root_r < start:
        flank.insert(0, (root_r, flank[0][1]))
    points = []
    for tooth in range(count):
        middle = 2 * pi * tooth / count + turned
        points += [(r * cos(middle - a), r * sin(middle - a)) for r, a in flank]
        points += [(r * cos(middle + a), r * sin(middle + a)) for r, a in reversed(flank)]
    return Polygon(*points, align=None)


def _strap(r, dx, dy):
    return make_hull([*Circle(r).edges(), *(Pos(dx, dy) * Circle(r)).edges()])


def board(part, pinion_r, slot, tee, tee_high, neck, float, board_thick, left=-70, right=190, half=92, rack_wide=18):
    """A board below z = 0, with a T-slot along y for the rack's keel."""
    body = Pos((left + right) / 2, 0, 0) * Box(right - left, 2 * half, board_thick, align=DOWN)
    body = fillet(body.edges().filter_by(Axis.Z), 6)
    body = chamfer(body.edges().group_by(Axis.Z)[-1], 1)
    x = -pinion_r - rack_wide / 2
    body -= Pos(x, 0, 0) * Box(slot + 0.4, 4 * half, 2 * neck, align=(Align.CENTER, Align.CENTER, Align.CENTER))
    body -= Pos(x, 0, -neck + 0.2) * Box(tee + 0.4, 4 * half, tee_high + 0.6, align=DOWN)
    return part.made(body)


def pinion(part, module, pinion_count, face, float, three, link, hub_d=18, arm=46, handle_d=12, handle=34):
    """Toothed from z = 0; above it a hub, an arm towards -y and a handle."""
    body = extrude(_wheel(module, pinion_count), face)
    top = three + link - float
    body += Pos(0, 0, face - 1) * Cylinder(hub_d / 2, top - face + 1, align=UP)
    figure = make_hull([*Circle(hub_d / 2).edges(), *(Pos(0, -arm) * Circle(7)).edges()])
    body += Pos(0, 0, three - float) * chamfer(extrude(figure, link).edges().group_by(Axis.Z)[0], 0.6)
    grip = Pos(0, -arm, top - 1) * Cylinder(handle_d / 2, handle + 1, align=UP)
    return part.made(body + fillet(grip.edges().sort_by(Axis.Z)[-1], 3))


def gear(part, module, gear_count, face, float, two, link, throw, crank_deg, pin_d):
    """Toothed from z = 0, a gap towards -x; a crank pin carries the coupler."""
    body = extrude(_wheel(module, gear_count, pi + pi / gear_count), face)
    x, y = throw * cos(radians(crank_deg)), throw * sin(radians(crank_deg))
    body += Pos(x, y, face - 1) * Cylinder(pin_d / 2, two - float + link - face + 1, align=UP)
    return part.made(body)


def coupler(p_x, p_y, q_x, q_y, link, float, pin_d, play=0.15, r=9):
    dx, dy = q_x - p_x, q_y - p_y
    body = extrude(_strap(r, dx, dy) - Circle(pin_d / 2 + play), link)
    body = chamfer(body.faces().filter_by(Axis.Z).sort_by(Axis.Z)[-1].edges(), 0.5)
    body += Pos(dx, dy, link - 1) * Cylinder(pin_d / 2, link + float + 1.5, align=UP)
    return body + Pos(dx, dy, 2 * link + float + 0.5) * Cylinder(7, 2.5, align=UP)


def rocker(part, q_x, q_y, pivot_x, pivot_y, link, three, pin_d, play=0.15, r=9):
    """From the knee at the origin to its pivot, which a foot carries down to the board."""
    dx, dy = pivot_x - q_x, pivot_y - q_y
    body = extrude(_strap(r, dx, dy) - Circle(pin_d / 2 + play), link)
    body = chamfer(body.faces().filter_by(Axis.Z).sort_by(Axis.Z)[-1].edges(), 0.5)
    body += Pos(dx, dy, 0.4 - three) * Cylinder(r, three, align=UP)
    return part.made(body)


def rack(module, face, pinion_count, slot, tee, tee_high, neck, float, wide=18, teeth_count=28):
    """Pitch line x = 0 with a gap at y = 0, the teeth towards +x, a T-shaped keel below."""
    pitch = pi * module
    half = (pitch / 2 - THIN) / 2
    slope = tan(PRESSURE)
    tip, root = TALL * module, -DEEP * module
    points = []
    first = -teeth_count / 2 + 0.5
    for tooth in range(teeth_count):
        y = (first + tooth) * pitch
        points += [(root, y - half + slope * root), (tip, y - half + slope * tip), (tip, y + half - slope * tip), (root, y + half - slope * root)]
    end = teeth_count / 2 * pitch
    outline = [(-wide, -end), (root, -end), *points, (root, end), (-wide, end)]
    body = extrude(Polygon(*outline, align=None), face)
    long = 2 * end
    body += Pos(-wide / 2, 0, 1) * Box(slot, long, neck + float + 1, align=DOWN)
    return body + Pos(-wide / 2, 0, -neck - float) * Box(tee, long, tee_high, align=DOWN)
