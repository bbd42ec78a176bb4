from build123d import Axis, Plane, Polyline, fillet, make_face, revolve


def vase(foot_d, rim_d, high, wall, bottom, inner=9, lip=1.5):
    """Turned profile; the corner inside is rounded, and so is the rim's inner edge."""
    slope = (rim_d - foot_d) / 2 / high
    low = foot_d / 2 + slope * bottom - wall
    profile = Polyline((0, 0), (foot_d / 2, 0), (rim_d / 2, high), (rim_d / 2 - wall, high), (low, bottom), (0, bottom), close=True)
    body = revolve(Plane.XZ * make_face(profile), Axis.Z)
    body = fillet(ring(body, bottom, low), inner)
    return fillet(ring(body, high, rim_d / 2 - wall), lip)


def ring(body, height, radius):
    """The edges that lie at a height on a radius about z."""
    boxes = [(e, e.bounding_box()) for e in body.edges()]
    return [e for e, b in boxes if abs(b.min.Z - height) + abs(b.max.Z - height) < 0.01 and abs(b.max.X - radius) < 0.01]
