from build123d import Plane, Polyline, Rectangle, Rot, extrude, make_face


def _trapezoid(along, off, outer, inner):
    """Between two lines parallel to the lower edge, cut by the mitres through the corners."""
    ends = [along / 2 - outer, along / 2 - inner]
    return make_face(Polyline((-ends[0], outer - off), (ends[0], outer - off), (ends[1], inner - off), (-ends[1], inner - off), close=True))


def rail(along, off, turn_deg, rail, thick, rebate, rebate_deep):
    """A mitred rail whose outer edge is off the frame's middle, then turned about y; Plane.XZ looks forward."""
    front = extrude(Plane.XZ * _trapezoid(along, off, 0, rail), -(thick - rebate_deep))
    behind = extrude(Plane.XZ.offset(rebate_deep - thick) * _trapezoid(along, off, 0, rail - rebate), -rebate_deep)
    return Rot(Y=turn_deg) * (front + behind)


def glass(pane_wide, pane_high, thin):
    return extrude(Plane.XZ * Rectangle(pane_wide, pane_high), -thin)


panel = glass
