from build123d import Align, Box


def block(block_side, block_high):
    return Box(block_side, block_side, block_high, align=(Align.CENTER, Align.CENTER, Align.MIN))
