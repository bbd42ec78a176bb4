from build123d import BuildSketch, Mode, Rectangle, extrude


def post(post_side, post_wall, post_high):
    with BuildSketch() as tube:
        Rectangle(post_side, post_side)
        Rectangle(post_side - 2 * post_wall, post_side - 2 * post_wall, mode=Mode.SUBTRACT)
    return extrude(tube.sketch, post_high)
