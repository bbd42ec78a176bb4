from build123d import Align, Axis, Box, Cylinder, Plane, Polyline, Pos, Rot, make_face, revolve

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def pulley(across, rim, hub, groove_top=13, groove_low=5, groove_deep=11, hub_d=36, bore=16, key=5, key_reach=10.3, screw=4.2):
    """Turned about z, the hub from z = 0 to hub, the rim above it."""
    r, middle, high = across / 2, hub + rim / 2, hub + rim
    low = r - groove_deep
    half = Polyline(
        (bore / 2, 0), (hub_d / 2, 0), (hub_d / 2, hub), (r, hub), (r, middle - groove_top / 2), (low, middle - groove_low / 2),
        (low, middle + groove_low / 2), (r, middle + groove_top / 2), (r, high), (bore / 2, high), close=True,
    )
    body = revolve(Plane.XZ * make_face(half), Axis.Z)
    body -= Box(key, key_reach, high, align=(Align.CENTER, Align.MAX, Align.MIN))
    return body - Pos(0, 0, hub / 2) * Rot(X=-90) * Cylinder(screw / 2, hub_d, align=UP)
