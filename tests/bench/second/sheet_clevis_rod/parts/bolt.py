from build123d import Axis, Plane, Polyline, make_face, revolve


def bolt(shank, groove, groove_top, groove_width, length=35, head=15, head_height=4, oil=3, oil_depth=21):
    top, seat = length + head_height, length - groove_top
    r, g = shank / 2, groove / 2
    outline = [(0, 0), (r, 0), (r, seat - groove_width), (g, seat - groove_width), (g, seat), (r, seat), (r, length), (head / 2, length)]
    outline += [(head / 2, top), (oil / 2, top), (oil / 2, top - oil_depth), (0, top - oil_depth), (0, 0)]
    return revolve(Plane.XZ * make_face(Polyline(*outline).edges()), Axis.Z)
