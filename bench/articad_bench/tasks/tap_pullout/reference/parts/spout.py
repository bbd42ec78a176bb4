from build123d import Align, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Pos(0, 0, 0.5) * Cylinder(d["body_radius"], d["post_height"] - 1, align=LOW)
    body += Pos(0, 0, d["post_height"] / 2) * Rot(Y=90) * Cylinder(d["tube_radius"], 90, align=LOW) + Pos(
        90, 0, d["post_height"] / 2
    ) * Sphere(d["tube_radius"])
    body += Pos(90, 0, d["post_height"] / 2) * Cylinder(d["tube_radius"], d["spout_rise"] - d["post_height"] / 2, align=LOW) + Pos(
        90, 0, d["spout_rise"]
    ) * Sphere(d["tube_radius"])
    body += Pos(90, 0, d["spout_rise"]) * Rot(Y=90) * Cylinder(d["tube_radius"], d["reach"] - 90, align=LOW) + Pos(
        d["reach"], 0, d["spout_rise"]
    ) * Sphere(d["tube_radius"] + 4)
    body += Pos(d["reach"], 0, d["spout_rise"]) * Cylinder(d["tube_radius"] + 4, 60, align=HIGH)
    body -= Pos(0, 0, -1) * Cylinder(d["post_radius"] + d["clearance"], d["post_height"] + 2, align=LOW)
    body -= Pos(d["reach"], 0, d["spout_rise"] + 4) * Cylinder(d["hose_radius"] + d["clearance"], 100, align=HIGH)

    return body, {
        "swivel": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
        "spray": {"o": (d["reach"], 0, d["spout_rise"] - 60), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
