from build123d import Align, Box, Cylinder, Pos, Rot

BACK = (Align.CENTER, Align.MAX, Align.MIN)
NEAR = (Align.CENTER, Align.MIN, Align.CENTER)


def build(part):
    d = part.dimensions
    body = Pos(0, -d["jaw_gap"], 4) * Box(d["jaw_width"], d["plate"], d["jaw_top"] - 4, align=BACK)
    body += Pos(0, -d["jaw_gap"] - d["plate"], d["beam_z"]) * Box(
        d["beam"], d["beam_end"] + d["jaw_gap"] + d["plate"], d["beam"], align=NEAR
    )
    body -= Pos(0, 0, d["spindle_z"]) * Rot(X=90) * Cylinder(d["spindle_radius"] + d["clearance"], 200)

    return body, {"slide": {"o": (0, 0, d["beam_z"]), "z": (0, -1, 0), "x": (1, 0, 0)}}
