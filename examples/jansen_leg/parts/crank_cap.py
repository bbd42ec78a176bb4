from build123d import Align, Axis, Cylinder, Rot, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    cap = Cylinder(d["radius"], d["length"], align=LOW)
    cap = chamfer(cap.edges().sort_by(Axis.Z)[-1], 1)
    cap -= Cylinder(d["hole_radius"], d["hole_depth"], align=LOW)
    return Rot(X=90) * cap, {"face": {"o": (0, 0, 0), "z": (0, -1, 0), "x": (0, 0, 1)}}
