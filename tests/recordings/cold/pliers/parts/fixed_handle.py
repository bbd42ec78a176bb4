from build123d import Align, Box, Cylinder, Line, Plane, Polyline, Pos, Rot, ThreePointArc, extrude, make_face


def build(part):
    d = part.dimensions
    rear, front = d["rear"], d["front_x"]
    inner, cheek = d["inner_half"], d["cheek"]
    bottom, top = d["bottom_z"], d["top_z"]
    lobe = d["lobe_radius"]
    outer = inner + cheek
    big = 2 * (rear + d["jaw_reach"])
    # outline of the cheeks, full width
    outline = make_face([
        Line((-rear, bottom), (-rear, top)),
        Line((-rear, top), (front, top)),
        Line((front, top), (front, bottom)),
        Line((front, bottom), (lobe, bottom)),
        Line((lobe, bottom), (lobe, 0)),
        ThreePointArc((lobe, 0), (0, -lobe), (-lobe, 0)),
        Line((-lobe, 0), (-lobe, bottom)),
        Line((-lobe, bottom), (-rear, bottom)),
    ])
    body = extrude(Plane.XZ * outline, amount=outer, both=True)
    # room between the cheeks, behind the jaw and below the web
    room_back = -(rear - d["nut_length"])
    roof = top - d["web"]
    body -= Pos(room_back, 0, roof) * Box(
        d["jaw_back_x"] - room_back, 2 * inner, big, align=(Align.MIN, Align.CENTER, Align.MAX))
    # between the cheeks below the gripping face
    body -= Pos(room_back, 0, d["face_z"]) * Box(
        front + 1 - room_back, 2 * inner, big, align=(Align.MIN, Align.CENTER, Align.MAX))
    # fixed jaw
    face_z = d["face_z"]
    jaw = extrude(Plane.XZ * make_face(Polyline(
        (d["jaw_back_x"], face_z), (d["jaw_reach"], face_z), (d["jaw_reach"], face_z + d["nose_height"]),
        (d["slope_x"], top), (d["jaw_back_x"], top), close=True)), amount=inner, both=True)
    body += jaw
    # grooves in the gripping face
    g = d["groove_depth"]
    for i in range(d["groove_count"]):
        x = d["groove_first_x"] + i * d["groove_pitch"]
        body -= extrude(Plane.XZ * make_face(Polyline(
            (x - g - 1, face_z - 1), (x + g + 1, face_z - 1), (x, face_z + g), close=True)),
            amount=inner + 1, both=True)
    # bores and slots
    body -= Pos(-rear - 1, 0, d["screw_z"]) * Rot(Y=90) * Cylinder(
        d["thread_bore_radius"], d["nut_length"] + 2, align=(Align.CENTER, Align.CENTER, Align.MIN))
    body -= Rot(X=90) * Cylinder(d["pin_bore_radius"], 2 * outer + 2)
    slot_back = -(d["guide_x"] + d["slot_rear"])
    slot_front = -(d["guide_x"] - d["slot_fore"])
    body -= Pos(slot_back, 0, d["screw_z"]) * Box(
        slot_front - slot_back, 2 * outer + 2, 2 * d["slot_half"], align=(Align.MIN, Align.CENTER, Align.CENTER))
    return body, {
        "jaw_pivot": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (1, 0, 0)},
        "block_guide": {"o": (-d["guide_x"], 0, d["screw_z"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
        "screw_thread": {"o": (-(rear - d["nut_length"] / 2), 0, d["screw_z"]), "z": (-1, 0, 0), "x": (0, 1, 0)},
    }
