from build123d import Circle, Rectangle, extrude


def slide(gap, pin_d, plate, block_wide, block_high):
    return extrude(Rectangle(block_wide, block_high) - Circle(pin_d / 2 + gap), plate)
