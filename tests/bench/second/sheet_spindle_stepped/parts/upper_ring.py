from build123d import Align, Circle, Rectangle, extrude


def upper_ring(upper_groove, upper_ring, outer=22, opening=7):
    ahead = (Align.MIN, Align.CENTER)
    return extrude(Circle(outer / 2) - Circle(upper_groove / 2) - Rectangle(outer, opening, align=ahead), -upper_ring)
