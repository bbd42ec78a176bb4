from build123d import Align, Circle, Cone, FilletPolyline, Plane, sweep


def handle(cup_low_d, cup_top_d, cup_high, bar=7, reach="cup_top_d / 2 + 20", bend=12):
    """A bent bar towards +x; its ends are cut to the cone of the cup, whose foot is at the origin."""
    high, low = 0.85 * cup_high, 0.25 * cup_high
    start = cup_low_d / 2
    path = Plane.XZ * FilletPolyline((start, high), (reach, high), (reach, 0.5 * cup_high), (start, low), radius=bend)
    rod = sweep(Plane(path @ 0, z_dir=path % 0) * Circle(bar / 2), path=path)
    return rod - Cone(cup_low_d / 2, cup_top_d / 2, cup_high, align=(Align.CENTER, Align.CENTER, Align.MIN))
