from build123d import Align, Box, Pos, Rot


def build(part):
    d = part.dimensions
    grip, apart, reach, lean_deg = d["grip"], d["apart"], d["reach"], d["lean_deg"]
    outside = Pos(reach / 2 - 10, 0, 0) * Box(reach + 20, grip, apart + grip)
    inside = Pos(reach / 2 - grip - 10, 0, 0) * Box(reach + 20, 2 * grip, apart - grip)
    shape = outside - inside - Rot(Y=lean_deg) * Box(400, 400, 400, align=(Align.MAX, Align.CENTER, Align.CENTER))
    return shape, {"cup": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
