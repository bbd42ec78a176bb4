from build123d import Align, Axis, Box, Cylinder, Pos, chamfer

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    radius, height = d["radius"], d["height"]
    disc = Cylinder(radius, height, align=LOW)
    head = chamfer(disc.edges().sort_by(Axis.Z)[-1], 2)
    pitch = 1.6 * radius / (d["fin_count"] - 1)
    fins = Cylinder(radius - 2, height + d["fin_height"], align=LOW)
    for i in range(d["fin_count"]):
        x = -0.8 * radius + i * pitch
        head += fins & Pos(x, 0, 0) * Box(0.35 * pitch, 4 * radius, 2 * (height + d["fin_height"]), align=LOW)
    return head + Cylinder(d["plug_radius"], height + d["plug_height"], align=LOW), {
        "face": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}
    }
