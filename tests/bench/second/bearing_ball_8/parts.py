from build123d import Align, Axis, Cylinder, PolarLocations, Pos, Sphere, Torus, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def _ring(outer, inner, wide, pitch, ball, play):
    """A flat ring with broken edges, less the groove in which the balls run."""
    ring = Cylinder(outer / 2, wide, align=LOW) - Cylinder(inner / 2, wide, align=LOW)
    ends = ring.edges().group_by(Axis.Z)
    ring = chamfer([*ends[0], *ends[-1]], 0.6)
    return ring - Pos(0, 0, wide / 2) * Torus(pitch / 2, ball / 2 + play)


def outer_ring(outside, pitch, ball, wide, play, land):
    return _ring(outside, pitch + land, wide, pitch, ball, play)


def inner_ring(bore, pitch, ball, wide, play, land):
    return _ring(pitch - land, bore, wide, pitch, ball, play)


def ball_cage(pitch, ball, sheet=1, tall=5, ball_count=8):
    """Balls around the origin, joined by a band of sheet."""
    cage = Cylinder(pitch / 2 + sheet / 2, tall) - Cylinder(pitch / 2 - sheet / 2, tall)
    for place in PolarLocations(pitch / 2, ball_count):
        cage += place * Sphere(ball / 2)
    return cage
