from build123d import Align, Cone


def pedestal(pedestal_high, neck, ground=260):
    return Cone(ground / 2, neck / 2, pedestal_high, align=(Align.CENTER, Align.CENTER, Align.MIN))
