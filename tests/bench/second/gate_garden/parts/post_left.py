from build123d import Align, Box, Circle, Pos, Rectangle, extrude


def post_left(post, post_high, gate_low, gate_high, axis_x, axis_y, hinge_d, lug, around=17):
    """A post with a lug below and one above the gate, each bored for a pin."""
    body = Box(post, post, post_high, align=(Align.MIN, Align.MIN, Align.MIN))
    arm = axis_x - post + 1
    flat = Pos(axis_x, axis_y) * Circle(around) + Pos(post - 1 + arm / 2, axis_y) * Rectangle(arm, 2 * around)
    flat -= Pos(axis_x, axis_y) * Circle(hinge_d / 2)
    for z in (gate_low - 4 - lug, gate_low + gate_high + 4):
        body += Pos(0, 0, z) * extrude(flat, lug)
    return body
