from build123d import Axis, Plane, Polyline, make_face, revolve


def body(neck_z, cap_z, stem, stem_long, play, base=64, base_z=28, waist=40, waist_low=48, waist_high=86, belly=58, belly_low=110, belly_high=128, neck=34, shoulder_z=132):
    bore, floor = stem / 2 + play, cap_z - stem_long - play
    outline = [(0, 0), (base / 2, 0), (base / 2, base_z), (waist / 2, waist_low), (waist / 2, waist_high), (belly / 2, belly_low)]
    outline += [(belly / 2, belly_high), (neck / 2, shoulder_z), (neck / 2, neck_z), (bore, neck_z), (bore, floor), (0, floor), (0, 0)]
    return revolve(Plane.XZ * make_face(Polyline(*outline)), Axis.Z)
