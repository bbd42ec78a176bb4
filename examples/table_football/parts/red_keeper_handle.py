from build123d import Align, Axis, Cylinder, Pos, RegularPolygon, Rot, chamfer, extrude

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    flats, length = d["across_flats"] / 2, d["length"]
    grip = extrude(RegularPolygon(flats, 8, major_radius=False), length)
    grip = chamfer(grip.edges().group_by(Axis.Z)[0] + grip.edges().group_by(Axis.Z)[-1], d["edge"])
    for z in (0.2 * length, 0.8 * length):
        ring = Cylinder(2 * flats, d["groove_width"]) - Cylinder(flats - d["groove_depth"], d["groove_width"])
        grip -= Pos(0, 0, z) * ring
    grip -= Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(X=90) * grip, {"seat": {"o": (0, -d["hole_depth"], 0), "z": (0, -1, 0), "x": (0, 0, 1)}}
