from build123d import Align, Box


def beam(beam_long, beam_wide, beam_high):
    return Box(beam_long, beam_wide, beam_high, align=(Align.CENTER, Align.CENTER, Align.MAX))


def leg(leg_wide, leg_thick, high):
    """From y = 0 outwards along +y."""
    return Box(leg_wide, leg_thick, high - leg_thick, align=(Align.CENTER, Align.MIN, Align.MIN))


def stretcher(leg_wide, leg_thick, stretcher_long):
    return Box(leg_wide, stretcher_long, leg_thick, align=(Align.CENTER, Align.CENTER, Align.MIN))
