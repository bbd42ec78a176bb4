from build123d import Align, Axis, Box, Cylinder, Plane, Pos, Rectangle, Rot, Sphere, chamfer, loft


def taper(below, above):
    """Loft between two (width along y, depth along x, z) sections."""
    return loft([Plane.XY.offset(z) * Rectangle(depth, width) for width, depth, z in (below, above)], ruled=True)


def build(part):
    d = part.dimensions
    hub, sole, torso = d["hub_radius"], -d["reach"], d["torso_width"]
    figure = Rot(X=90) * Cylinder(hub, d["hub_width"])
    figure += taper((0.8 * torso, 1.4 * hub, 0), (torso, 1.1 * hub, d["torso_top"]))
    figure += Pos(0, 0, d["torso_top"]) * Cylinder(0.4 * d["head_radius"], 2 * d["head_radius"])
    figure += Pos(0, 0, d["torso_top"] + 1.2 * d["head_radius"]) * Sphere(d["head_radius"])

    top = sole + d["foot_height"]
    figure += taper((0.6 * d["foot_width"], 0.6 * d["foot_length"], top), (0.8 * torso, 1.4 * hub, 0))
    foot = Pos(0, 0, sole) * Box(d["foot_length"], d["foot_width"], d["foot_height"], align=(Align.CENTER, Align.CENTER, Align.MIN))
    figure += chamfer(foot.edges().group_by(Axis.Z)[-1], 3)
    figure -= Rot(X=90) * Cylinder(d["bore_radius"], 2 * d["hub_width"])
    return figure, {"hub": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)}}
