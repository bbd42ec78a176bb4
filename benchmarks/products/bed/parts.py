from build123d import Align, Axis, Box, Cylinder, Pos, Rot, fillet

C, LOW, TOP = Align.CENTER, Align.MIN, Align.MAX


def frame(d):
    body = Pos(0, d.head, d.thick / 2) * Box(d.wide, d.long, d.thick, align=(C, TOP, TOP))
    for side in (-1, 1):
        lug = Box(d.lug_wide, d.lug, d.lug / 2 - d.lw, align=(C, C, TOP))
        body += Pos(side * (d.lug_x + d.lug_wide / 2), -d.lu) * lug
    return body - Pos(d.wide / 2) * Rot(Y=90) * Cylinder(d.fold_bore / 2, 2 * (d.fold_depth - 2))


def cylinder(d):
    body = Rot(Y=90) * Cylinder(d.eye, d.thick) + Rot(X=90) * Cylinder(d.radius, d.long, align=(C, C, LOW))
    body -= Pos(0, -d.start) * Rot(X=90) * Cylinder(d.bore, d.long, align=(C, C, LOW))
    for side in (-1, 1):
        body -= Pos(side * (d.thick / 2 + d.eye)) * Rot(Y=90) * Cylinder(d.eye, 2 * d.eye)
    return body


def leg(d):
    body = Pos(Z=-d.long + d.bar) * Box(2 * d.x, d.thick, d.bar, align=(C, C, TOP))
    for side in (-1, 1):
        body += Pos(side * d.x) * (Box(d.wide, d.thick, d.long, align=(C, C, TOP)) + Rot(Y=90) * Cylinder(d.eye, d.wide))
    return body


def disc(d, side):
    return Pos(side * d.thick / 2) * Rot(Y=90) * Cylinder(d.radius, d.thick)


def build(part):
    d = part.dimensions
    match part.name:
        case "cabinet":
            shape = Box(d.inner + 2 * d.board, d.depth, d.high, align=(C, TOP, LOW))
            shape -= Pos(0, -d.back, d.board) * Box(d.inner, d.depth, d.high - 2 * d.board, align=(C, TOP, LOW))
        case "frame":
            shape = frame(d)
        case "mattress":
            body = Box(d.wide, d.long, d.thick, align=(C, TOP, LOW))
            shape = fillet(body.edges().filter_by(Axis.Z), 0.05 * d.wide)
        case "cylinder_l":
            shape = cylinder(d)
        case "rod_l":
            shape = Rot(Y=90) * Cylinder(d.eye, d.thick) + Rot(X=-90) * Cylinder(d.radius, d.long, align=(C, C, LOW))
        case "leg":
            shape = leg(d)
        case "side_pin_l" | "leg_pin_l":
            shape = disc(d, -1)
        case _:
            shape = disc(d, 1)
    return part.made(shape)
