from build123d import Circle, GridLocations, Plane, Polyline, Pos, Rectangle, extrude, make_face


def bracket(wide, deep, tall, thick, rib=6, rib_leg=41, hole=5.5, apart=24, tall_hole=64, deep_hole=45):
    """The tall leg lies along +y with its outer face on z = 0, the other rises along -z."""
    half = wide / 2
    leg = extrude(Pos(0, tall / 2) * Rectangle(wide, tall) - Pos(0, tall_hole) * GridLocations(apart, 1, 2, 1) * Circle(hole / 2), -thick)
    other = extrude(Plane.ZX * (Pos(-deep / 2, 0) * Rectangle(deep, 2 * half) - Pos(-deep_hole, 0) * GridLocations(1, apart, 1, 2) * Circle(hole / 2)), thick)
    web = Plane.YZ * make_face(Polyline((thick, -thick), (thick + rib_leg, -thick), (thick, -thick - rib_leg), close=True))
    return leg + other + extrude(web, rib / 2, both=True)
