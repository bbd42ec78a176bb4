from build123d import Align, Axis, Cone, Cylinder, Pos, fillet

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    low, middle = 0.7 * d["length"], 0.3 * d["length"]
    grip = Cone(d["end_radius"], d["radius"], low, align=LOW)
    grip += Pos(0, 0, low) * Cone(d["radius"], d["end_radius"], middle, align=LOW)
    grip = Pos(0, 0, -d["seat"]) * fillet(grip.edges().sort_by(Axis.Z)[-1], 4)
    return grip - Cylinder(d["hole_radius"], 2 * d["seat"], align=HIGH), {"seat": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
