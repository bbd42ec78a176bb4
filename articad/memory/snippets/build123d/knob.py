"""A lathe-turned knob: an outline revolved about an axis

Shows: revolve, Polyline, make_face
Dimensions: {"foot": 6, "neck": 4, "head": 12, "low": 8, "height": 20}
"""

from build123d import Axis, Plane, Polyline, make_face, revolve


def build(part):
    d = part.dimensions
    corners = [(0, 0), (d["foot"], 0), (d["neck"], d["low"]), (d["head"], d["low"] + 4), (d["head"], d["height"]), (0, d["height"])]
    shape = revolve(make_face(Plane.XZ * Polyline(*corners, close=True)), axis=Axis.Z)
    return shape, {"mount": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
