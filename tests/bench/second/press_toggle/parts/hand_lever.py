from build123d import Circle, Pos, Rot, SlotCenterPoint, extrude


def between(a, b, width):
    middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    return SlotCenterPoint(middle, b, width)


def hand_lever(crank_x, crank_z, link, pin_d, play, tip_x=107, tip_z=169.8, sheet=9):
    """Handle and crank in one plate, bored at the pivot, which is the origin, and at the crank."""
    crank = (crank_x, crank_z)
    flat = between(crank, (tip_x, tip_z), link) + between(crank, (0, 0), link - 2)
    hole = Circle(pin_d / 2 + play)
    flat = flat - hole - Pos(*crank) * hole
    return Rot(X=90) * extrude(flat, sheet)
