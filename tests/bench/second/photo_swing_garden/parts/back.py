from build123d import Align, Box


def back(half, back, high):
    return Box(2 * half, back, high, align=(Align.CENTER, Align.MAX, Align.MIN))
