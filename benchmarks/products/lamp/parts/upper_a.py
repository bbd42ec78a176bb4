from build123d import Plane, SlotCenterToCenter, Pos, extrude


def build(part):
    d = part.dimensions
    along = Pos(0, 0, d.long / 2) if part.name == "lower_a" else Pos(d.long / 2, -d.thick)
    flat = Plane((0, d.thick, 0), x_dir=(0, 0, 1) if part.name == "lower_a" else (1, 0, 0), z_dir=(0, -1, 0))
    return part.made(along * extrude(flat * SlotCenterToCenter(d.long, d.wide), d.thick))
