from build123d import Align, Circle, Rectangle, extrude


def ring(groove, ring, outer=26, opening=8):
    ahead = (Align.MIN, Align.CENTER)
    return extrude(Circle(outer / 2) - Circle(groove / 2) - Rectangle(outer, opening, align=ahead), -ring)
