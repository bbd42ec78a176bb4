from build123d import Align, Box, Cylinder, GridLocations, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def housing(side, flange, high, boss_d, seat_d, seat_depth, bore_d, square_pitch, bolt_d, sink_d, sink, dowel_d, dowel, oil_d, oil_hole_height,
            dowel_1_x=15, dowel_1_y=35, dowel_2_x=95, dowel_2_y=63):
    body = Box(side, side, flange, align=UP) + Cylinder(boss_d / 2, high, align=UP)
    body -= Pos(0, 0, high) * Cylinder(seat_d / 2, seat_depth, align=DOWN)
    body -= Cylinder(bore_d / 2, 3 * high)
    for place in GridLocations(square_pitch, square_pitch, 2, 2):
        body -= place * Cylinder(bolt_d / 2, 3 * flange)
        body -= Pos(0, 0, flange) * place * Cylinder(sink_d / 2, sink, align=DOWN)
    for x, y in ((dowel_1_x, dowel_1_y), (dowel_2_x, dowel_2_y)):
        body -= Pos(x - side / 2, y - side / 2, 0) * Cylinder(dowel_d / 2, dowel, align=UP)
    return body - Pos(seat_d / 2 - 4, 0, oil_hole_height) * Rot(Y=90) * Cylinder(oil_d / 2, boss_d, align=UP)
