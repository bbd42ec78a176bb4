from build123d import Align, Box


def post_right(post, post_high):
    return Box(post, post, post_high, align=(Align.MIN, Align.MIN, Align.MIN))
