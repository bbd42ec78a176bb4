from build123d import Align, Box, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def body(pitch, outer_d, tall, chamber_d, chamber_depth, shaft_d, blind, port_d, port_height, rim_radius, bolt_d, bolt_deep, dowel_d, dowel_deep, dowel_a_deg, dowel_b_deg):
    left, right, sole = Pos(X=-pitch / 2), Pos(X=pitch / 2), tall - chamber_depth
    block = Box(pitch, outer_d, tall, align=UP) + left * Cylinder(outer_d / 2, tall, align=UP) + right * Cylinder(outer_d / 2, tall, align=UP)
    for place in (left, right):
        block -= place * Pos(Z=sole) * Cylinder(chamber_d / 2, tall, align=UP)
    block -= left * Cylinder(shaft_d / 2, tall, align=UP) + right * Pos(Z=sole - blind) * Cylinder(shaft_d / 2, tall, align=UP)
    block -= Pos(Z=port_height) * Rot(X=90) * Cylinder(port_d / 2, 2 * outer_d)
    bolts = [(left, 90), (left, 180), (left, -90), (right, 90), (right, 0), (right, -90)]
    holes = [(place, turn, bolt_d, bolt_deep) for place, turn in bolts]
    holes += [(left, dowel_a_deg, dowel_d, dowel_deep), (right, dowel_b_deg, dowel_d, dowel_deep)]
    for place, turn, across, deep in holes:
        block -= place * Rot(Z=turn) * Pos(rim_radius, 0, tall - deep) * Cylinder(across / 2, tall, align=UP)
    return block
