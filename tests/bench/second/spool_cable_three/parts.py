from build123d import Circle, Pos, extrude


def core(core_d, core_in, core_long):
    return extrude(Circle(core_d / 2) - Circle(core_in / 2), core_long / 2, both=True)


def cheek(cheek_d, cheek_thick, spindle=30, poke=12, poke_off=90):
    """A disc from z = 0; the cable's hole is at +y."""
    return extrude(Circle(cheek_d / 2) - Circle(spindle / 2) - Pos(0, poke_off) * Circle(poke / 2), cheek_thick)
