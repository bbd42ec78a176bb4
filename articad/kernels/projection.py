"""Views of shapes as lines on paper: visible edges, hidden edges and cut faces. Runs inside the sandbox, in a process that ran no script.

A line on paper is `["line", x0, y0, x1, y1]`, `["arc", x, y, radius, start, end]` (counterclockwise, degrees) or `["path", [x0, y0, x1, y1, ...]]`,
in mm of the part, from the image of the origin.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from build123d import Compound, Edge, GeomType
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common
from OCP.BRepLib import BRepLib
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.GCPnts import GCPnts_TangentialDeflection
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Line, GeomAbs_Plane, GeomAbs_Sphere
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.HLRAlgo import HLRAlgo_Projector
from OCP.HLRBRep import HLRBRep_Algo, HLRBRep_HLRToShape
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID, TopAbs_WIRE
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Shape

from articad.aliases import Json
from articad.kernels.measure import found

ANGLE, SAG_SHARE = 0.12, 2e-4  # of paths: largest turn [rad], and deflection as a share of the shape's size
_SAME = 1e-6  # mm

Line = list[Any]


def projected(shape: TopoDS_Shape, view: Json) -> Json:
    """Return the lines of one view.

    Args:
        shape: In its frame [mm].
        view: `right` and `up` on the paper, `(3,)` unit vectors; `hidden`, whether hidden edges count; `cut`, None or the distance of a
            plane across the view from the origin, towards the eye: what is nearer to the eye is cut away.
    """
    right, up = np.array(view["right"]), np.array(view["up"])
    eye = np.cross(right, up)
    size = _size(shape)
    report: Json = {"name": view["name"], "visible": [], "hidden": [], "cut": []}
    if view.get("cut") is not None:
        shape = _beyond(shape, eye, float(view["cut"]), size)
        report["cut"] = [_loops(face, right, up, size) for face in _cut_faces(shape, eye, float(view["cut"]))]
    algorithm = HLRBRep_Algo()
    algorithm.Add(shape)
    algorithm.Projector(HLRAlgo_Projector(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(*eye.tolist()), gp_Dir(*right.tolist()))))
    algorithm.Update()
    algorithm.Hide()
    # sharp edges and outlines; not the seams of surfaces, nor edges at which two surfaces are tangent to each other
    lines = HLRBRep_HLRToShape(algorithm)
    report["visible"] = _unique(_edges((lines.VCompound(), lines.OutLineVCompound()), size))
    if view.get("hidden"):
        report["hidden"] = _unique(_edges((lines.HCompound(), lines.OutLineHCompound()), size))
    return report


def features(shape: TopoDS_Shape) -> Json:
    """Return what dimensions measure [mm, rad].

    Straight edges are `[x0, y0, z0, x1, y1, z1]`, circles and arcs `[x, y, z, axis (3), radius, angle]`, spherical faces `[x, y, z, radius]`.
    """
    straight, circles, spheres = [], [], []
    for item in found(shape, TopAbs_EDGE):
        edge = TopoDS.Edge(item)
        if BRep_Tool.Degenerated_s(edge):
            continue
        curve = BRepAdaptor_Curve(edge)
        if curve.GetType() == GeomAbs_Line:
            ends = (curve.Value(curve.FirstParameter()), curve.Value(curve.LastParameter()))
            straight.append([number for point in ends for number in (point.X(), point.Y(), point.Z())])
        elif curve.GetType() == GeomAbs_Circle:
            circle = curve.Circle()
            centre, axis = circle.Location(), circle.Axis().Direction()
            circles.append(
                [
                    centre.X(),
                    centre.Y(),
                    centre.Z(),
                    axis.X(),
                    axis.Y(),
                    axis.Z(),
                    circle.Radius(),
                    curve.LastParameter() - curve.FirstParameter(),
                ]
            )
    for face in found(shape, TopAbs_FACE):
        surface = BRepAdaptor_Surface(TopoDS.Face(face))
        if surface.GetType() == GeomAbs_Sphere:
            sphere = surface.Sphere()
            spheres.append([sphere.Location().X(), sphere.Location().Y(), sphere.Location().Z(), sphere.Radius()])
    return {"straight": straight, "circles": circles, "spheres": spheres}


def _size(shape: TopoDS_Shape) -> float:
    box = Compound(shape).bounding_box()
    return float(max(box.diagonal, box.min.length, box.max.length))


def _beyond(shape: TopoDS_Shape, eye: Any, at: float, size: float) -> TopoDS_Shape:
    """Return what lies beyond a plane, seen from the eye."""
    far, side = 4.0 * size, 8.0 * size
    x = np.eye(3)[int(np.abs(eye).argmin())]
    x = x - (x @ eye) * eye
    x /= np.linalg.norm(x)
    y = np.cross(-eye, x)
    corner = at * eye - 0.5 * side * (x + y)
    frame = gp_Ax2(gp_Pnt(*corner), gp_Dir(*(-eye)), gp_Dir(*x))
    room = BRepPrimAPI_MakeBox(frame, side, side, far).Shape()
    solids = list(found(shape, TopAbs_SOLID))
    if len(solids) < 2:
        return BRepAlgoAPI_Common(shape, room).Shape()
    builder, rest = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(rest)
    for solid in solids:  # each by itself: of solids that touch, the common part of all at once may lack some
        builder.Add(rest, BRepAlgoAPI_Common(solid, room).Shape())
    return rest


def _cut_faces(shape: TopoDS_Shape, eye: Any, at: float) -> Iterator[TopoDS_Shape]:
    """Yield the faces that the plane of a section has made."""
    for face in found(shape, TopAbs_FACE):
        surface = BRepAdaptor_Surface(TopoDS.Face(face))
        if surface.GetType() != GeomAbs_Plane:
            continue
        plane = surface.Plane()
        point, normal = plane.Location(), plane.Axis().Direction()
        away = np.array([normal.X(), normal.Y(), normal.Z()]) @ eye
        if abs(abs(away) - 1.0) < _SAME and abs(np.array([point.X(), point.Y(), point.Z()]) @ eye - at) < 1e-4:
            yield face


def _loops(face: TopoDS_Shape, right: Any, up: Any, size: float) -> list[list[float]]:
    """Return the outlines of a plane face on the paper, as closed paths `[x0, y0, ...]`, outer and inner alike."""
    loops = []
    for wire in found(face, TopAbs_WIRE):
        points = [
            point for edge in Compound(wire).wires()[0].order_edges() for point in _points(BRepAdaptor_Curve(edge.wrapped), size, edge)
        ]
        loops.append([number for point in points for number in (float(point @ right), float(point @ up))])
    return loops


def _points(curve: Any, size: float, edge: Edge) -> list[Any]:
    sampled = GCPnts_TangentialDeflection(curve, ANGLE, SAG_SHARE * size)
    points = [np.array([p.X(), p.Y(), p.Z()]) for p in (sampled.Value(i) for i in range(1, sampled.NbPoints() + 1))]
    start = np.array(tuple(edge.position_at(0)))
    return points if np.linalg.norm(points[0] - start) <= np.linalg.norm(points[-1] - start) else points[::-1]


def _edges(compounds: Sequence[TopoDS_Shape | None], size: float) -> list[Line]:
    found_lines = []
    for compound in compounds:
        if compound is not None and not compound.IsNull():
            BRepLib.BuildCurves3d_s(compound)
            found_lines += [line for edge in found(compound, TopAbs_EDGE) for line in _drawn(Edge(TopoDS.Edge(edge)), size)]
    return found_lines


def _drawn(edge: Edge, size: float) -> Iterator[Line]:
    """Yield the line on paper of a projected edge, which lies in the plane z = 0."""
    curve = BRepAdaptor_Curve(edge.wrapped)
    first, last = curve.FirstParameter(), curve.LastParameter()
    start, end = curve.Value(first), curve.Value(last)
    if edge.geom_type == GeomType.LINE:
        if math.hypot(end.X() - start.X(), end.Y() - start.Y()) > _SAME:
            yield ["line", start.X(), start.Y(), end.X(), end.Y()]
        return
    if edge.geom_type == GeomType.CIRCLE:
        circle = curve.Circle()
        centre, radius, axis = circle.Location(), circle.Radius(), circle.Axis().Direction().Z()
        angles = [math.degrees(math.atan2(p.Y() - centre.Y(), p.X() - centre.X())) for p in (start, end)]
        sweep = math.degrees(last - first)
        begin = angles[0] if axis > 0 else angles[1]
        yield ["arc", centre.X(), centre.Y(), radius, begin, begin + min(sweep, 360.0)]
        return
    sampled = GCPnts_TangentialDeflection(curve, ANGLE, SAG_SHARE * size)
    points = [sampled.Value(i) for i in range(1, sampled.NbPoints() + 1)]
    # a straight edge that was projected as a spline is a line
    flat = [number for point in points for number in (point.X(), point.Y())]
    if len(points) == 2:
        if math.hypot(flat[2] - flat[0], flat[3] - flat[1]) > _SAME:
            yield ["line", *flat]
    elif len(points) > 2:
        yield ["path", flat]


def _unique(lines: list[Line]) -> list[Line]:
    """Return lines without those that lie on another one: edges behind each other are projected to the same place."""
    kept: dict[tuple[Any, ...], Line] = {}
    for line in lines:
        if line[0] == "line":
            ends = sorted([(round(line[1], 4), round(line[2], 4)), (round(line[3], 4), round(line[4], 4))])
            kept.setdefault(("line", *ends), line)
        elif line[0] == "arc":
            kept.setdefault(("arc", *(round(number, 4) for number in line[1:])), line)
        else:
            kept.setdefault(("path", *(round(number, 4) for number in line[1])), line)
    return list(kept.values())
