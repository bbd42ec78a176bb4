from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    drum = Cylinder(d["radius"], d["width"], align=LOW)
    for z in (0, d["width"] - d["rim_width"]):
        drum += Pos(0, 0, z) * Cylinder(d["radius"] + d["rim_height"], d["rim_width"], align=LOW)
    drum -= Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(Y=-90) * drum, {"face": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)}}
