from build123d import Align, Cylinder, Pos, Rot

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    ls, tf = d["spigot_length"], d["flange_thickness"]
    shape = Rot(X=-90) * Cylinder(d["flange_radius"], tf, align=UP)
    shape += Pos(0, -ls, 0) * Rot(X=-90) * Cylinder(d["spigot_radius"], ls + tf / 2, align=UP)
    shape -= Pos(0, -ls - 1, 0) * Rot(X=-90) * Cylinder(d["bore_radius"], ls + tf + 2, align=UP)
    c = part.connectors["seat"]
    return shape, {"seat": {"o": (0, 0, 0), "z": c.z, "x": c.x}}
