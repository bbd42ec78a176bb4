import math

from build123d import Cylinder, Line, Plane, Polyline, Pos, Rot, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    face_z, reach = d["face_z"], d["jaw_reach"]
    body = extrude(Plane.XZ * make_face(Polyline(
        (0, face_z), (reach, face_z), (reach, face_z - d["nose_height"]),
        (d["belly_x"], -d["belly_depth"]), (d["heel_x"], -d["heel_depth"]), (0, -d["root_depth"]),
        close=True)), amount=d["jaw_half"], both=True)
    body += Rot(X=90) * Cylinder(d["hub_radius"], 2 * d["hub_half"])
    body += Rot(X=90) * Cylinder(d["pin_radius"], 2 * d["pin_half"])
    # lug: bar from the origin to B with a round end
    lx, lz, r = d["lug_x"], -d["lug_z"], d["lug_radius"]
    length = math.hypot(lx, lz)
    ux, uz = lx / length, lz / length
    nx, nz = -uz * r, ux * r
    lug = make_face([
        Line((nx, nz), (lx + nx, lz + nz)),
        ThreePointArc((lx + nx, lz + nz), (lx + ux * r, lz + uz * r), (lx - nx, lz - nz)),
        Line((lx - nx, lz - nz), (-nx, -nz)),
        Line((-nx, -nz), (nx, nz)),
    ])
    body += extrude(Plane.XZ * lug, amount=d["lug_half"], both=True)
    # grooves in the gripping face
    g = d["groove_depth"]
    for i in range(d["groove_count"]):
        x = d["groove_first_x"] + i * d["groove_pitch"]
        body -= extrude(Plane.XZ * make_face(Polyline(
            (x - g - 1, face_z + 1), (x + g + 1, face_z + 1), (x, face_z - g), close=True)),
            amount=d["jaw_half"] + 1, both=True)
    body -= Pos(lx, 0, lz) * Rot(X=90) * Cylinder(d["bore_radius"], 2 * d["lug_half"] + 2)
    c = part.connectors
    return body, {
        "pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": c["pivot"].x},
        "handle_pivot": {"o": (lx, 0, lz), "z": (0, -1, 0), "x": c["handle_pivot"].x},
    }
