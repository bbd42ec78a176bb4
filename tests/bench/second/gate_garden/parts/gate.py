from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.MIN, Align.CENTER, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)


def gate(
    axis_x, axis_y, gate_low, gate_high, gate_thick, edge, hinge_d, latch_x, latch_z, latch_d, bolt_x, play, stile=40, bars_count=8, bar=16, bore=50
):
    """A welded frame, the hinge's axis at its origin; the left stile is round about that axis."""

    def block(x0, x1, z0, z1, thick=gate_thick):
        return Pos(x0, 0, z0) * Box(x1 - x0, thick, z1 - z0, align=LOW)

    left = stile - gate_thick / 2
    frame = Cylinder(gate_thick / 2, gate_high, align=UP) + block(0, left, 0, gate_high)
    frame += block(edge - stile, edge, 0, gate_high)
    middle = latch_z - gate_low
    for z in (0, middle - stile / 2, gate_high - stile):
        frame += block(left - 1, edge - stile + 1, z, z + stile)
    post = bolt_x - axis_x
    frame += block(post - stile / 2, post + stile / 2, 0, middle)
    step = (edge - stile - left) / (bars_count + 1)
    for number in range(1, bars_count + 1):
        x = left + number * step
        frame += block(x - bar / 2, x + bar / 2, stile / 2, gate_high - stile / 2, bar)
    for z in (0, gate_high):
        frame -= Pos(0, 0, z) * Cylinder(hinge_d / 2 + play, 2 * bore)
    front = Pos(latch_x - axis_x, -axis_y, middle) * Rot(X=-90)
    return frame - front * Cylinder(latch_d / 2, gate_thick, align=(Align.CENTER, Align.CENTER, Align.CENTER))
