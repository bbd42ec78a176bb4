from build123d import *

C, LOW, TOP = Align.CENTER, Align.MIN, Align.MAX


def across(radius, length, x=0):
    return Pos(x) * Rot(Y=90) * Cylinder(radius, length)


def cabinet(inner, board=20, depth=350, high=2300, back=10):
    body = Box(inner + 2 * board, depth, high, align=(C, TOP, LOW))
    return body - Pos(0, -back, board) * Box(inner, depth, high - 2 * board, align=(C, TOP, LOW))


def frame(wide, thick, head, lx, lu, lw, gap, fold_bore, fold_depth, long=2000, lug=30):
    body = Pos(0, head) * Box(wide, long, thick, align=(C, TOP, C))
    for x in (-lx - 25 - gap, lx + 25 + gap):
        body += Pos(x, -lu) * Box(20, lug, lug / 2 - lw, align=(C, C, TOP))
    return body - across(fold_bore / 2, 2 * fold_depth - 4, wide / 2)


def mattress(wide=860, long=1900, thick=120):
    body = Box(wide, long, thick, align=(C, TOP, LOW))
    return fillet(body.edges().filter_by(Axis.Z), wide / 20)


def cylinder(radius=11, long=300, start=30, bore=4.7, eye=13, thick=10):
    body = across(eye, thick) + Rot(X=90) * Cylinder(radius, long, align=(C, C, LOW))
    body -= Pos(0, -start) * Rot(X=90) * Cylinder(bore, long, align=(C, C, LOW))
    for x in (-thick / 2 - eye, thick / 2 + eye):
        body -= across(eye, 2 * eye, x)
    return body


def rod(radius=4.5, long=340, eye=13, thick=10):
    return across(eye, thick) + Rot(X=-90) * Cylinder(radius, long, align=(C, C, LOW))


def leg(lx, pz, lw, wide=30, thick=20, eye=13, bar=30):
    body = Pos(Z=bar - pz - lw) * Box(2 * lx, thick, bar, align=(C, C, TOP))
    for x in (-lx, lx):
        body += Pos(x) * Box(wide, thick, pz + lw, align=(C, C, TOP)) + across(eye, wide, x)
    return body
