from build123d import Align, Cylinder, Pos, RegularPolygon, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def housing(across, tall, seat, port_d, stem_d, play, chamber_d, chamber, spigot_d, spigot):
    """Hexagonal body; the inlet comes from below, the outlet leaves towards +x."""
    body = Pos(0, 0, -seat) * extrude(RegularPolygon(across / 2, 6, major_radius=False), tall)
    body -= Pos(0, 0, -seat) * Cylinder(port_d / 2, tall, align=UP)
    body -= Cylinder(chamber_d / 2, chamber, align=UP)
    body -= Cylinder(stem_d / 2 + play, tall, align=UP)
    body -= Pos(0, 0, tall - seat - spigot) * Cylinder(spigot_d / 2, spigot, align=UP)
    return body - Pos(0, 0, chamber / 2) * Rot(Y=90) * Cylinder(port_d / 2, across, align=UP)
