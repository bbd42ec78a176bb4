from math import radians, tan

from build123d import Align, Box, Cone, Cylinder, Pos, Rot, Sphere

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    body = (
        Pos(0, 0, 25) * Box(d["chest"], 30, 50)
        + Cylinder(13, 90)
        + Pos(0, 0, -40) * Box(60, 28, 26)
        + Pos(0, 0, 40) * Cylinder(8, 18, align=LOW)
    )
    flare = Rot(X=180) * Cone(0, 40 * tan(radians(d["opening_deg"])), 40, align=LOW)
    places = [
        Pos(-d["shoulder_x"], 0, d["shoulder_z"]) * Rot(Y=90),
        Pos(d["shoulder_x"], 0, d["shoulder_z"]) * Rot(Y=-90),
        Pos(-d["hip_x"], 0, d["hip_z"]),
        Pos(d["hip_x"], 0, d["hip_z"]),
        Pos(0, 0, d["head_z"]) * Rot(X=180),
    ]
    for place in places:
        body += place * Sphere(d["socket"])
    for place in places:
        body -= place * Sphere(d["ball"] + d["clearance"])
        body -= place * (flare & Sphere(d["socket"] + 8))

    return body, {
        "neck": {"o": (0, 0, d["head_z"]), "z": (0, 0, 1), "x": (1, 0, 0)},
        "shoulder": {"o": (d["shoulder_x"], 0, d["shoulder_z"]), "z": (1, 0, 0), "x": (0, 1, 0)},
        "right_shoulder": {"o": (-d["shoulder_x"], 0, d["shoulder_z"]), "z": (-1, 0, 0), "x": (0, -1, 0)},
        "hip": {"o": (d["hip_x"], 0, d["hip_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
        "right_hip": {"o": (-d["hip_x"], 0, d["hip_z"]), "z": (0, 0, -1), "x": (1, 0, 0)},
    }
