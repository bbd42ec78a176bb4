"""Measure, mesh and write a shape from a script or a file. Runs inside the sandbox, in a process that ran no script.

So a script that tampers with the kernel can spoil its own shape, but not the measurements.
"""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from OCP.BinTools import BinTools
from OCP.Bnd import Bnd_Box
from OCP.BOPAlgo import BOPAlgo_ArgumentAnalyzer, BOPAlgo_CheckStatus
from OCP.BRep import BRep_Builder
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Trsf
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Shape
from OCP.TopTools import TopTools_FormatVersion

from articad.aliases import Json
from articad.kernels.tessellation import Mesh, Same, is_closed, tessellate

EMPTY_MM3 = 1e-3  # the contract's smallest volume
STEP_TIME = "2000-01-01T00:00:00"
ZIP_TIME = (2000, 1, 1, 0, 0, 0)
_STEP_TIME_FIELD = re.compile(rb"(FILE_NAME\('(?:[^']|'')*',\s*')[^']*'")


class Measured(NamedTuple):
    """Results for a shape: numbers for `result.json`, and files by name."""

    report: Json
    files: dict[str, bytes]


def read_shape(form: str, content: bytes) -> TopoDS_Shape:
    """Read a shape.

    Args:
        form: `bin` (between two processes of articad), `brep` or `step`.
        content: The file.

    Raises:
        ValueError: If it contains no shape.
    """
    shape = TopoDS_Shape()
    if form == "bin":
        BinTools.Read_s(shape, io.BytesIO(content))
    elif form == "brep":
        BRepTools.Read_s(shape, io.BytesIO(content), BRep_Builder())
    else:
        reader = STEPControl_Reader()
        if reader.ReadStream("part", io.BytesIO(content)) != IFSelect_ReturnStatus.IFSelect_RetDone:
            raise ValueError("this is not a STEP file")
        reader.TransferRoots()
        shape = reader.OneShape()
    if shape.IsNull():
        raise ValueError("it holds no shape")
    return shape


def measure(
    shape: TopoDS_Shape, *, deflection: float, angle: float, name: str, matrix: list[list[float]] | None = None, place: int | None = None
) -> Measured:
    """Measure a shape and, if it is one solid with volume, mesh it and write it.

    Args:
        shape: As read.
        deflection: Linear deflection of the mesh [mm].
        angle: Angular deflection of the mesh [rad].
        name: Product name in the STEP file.
        matrix: Rigid motion or reflection `(4, 4)` to apply first.
        place: Which one of several solids to measure alone; by default the shape must be one solid.
    """
    solids = list(found(shape, TopAbs_SOLID))
    if place is not None:
        solids = solids[place : place + 1]
        shape = solids[0] if solids else shape
    loose = sum(1 for _ in found(shape, TopAbs_FACE, avoid=TopAbs_SOLID)) + sum(1 for _ in found(shape, TopAbs_EDGE, avoid=TopAbs_FACE))
    report: Json = {"ok": True, "solids": len(solids), "loose": loose}
    if len(solids) != 1:
        return Measured(report, {})
    solid = TopoDS.Solid(solids[0])
    if matrix is not None:
        solid = _moved(solid, matrix)
    report |= properties(solid) | {"valid": is_valid(solid), "closed": False}
    if report["volume_mm3"] < EMPTY_MM3:
        return Measured(report, {})
    mesh = tessellate(solid, deflection, angle)
    report["closed"] = is_closed(mesh.triangles)
    BRepTools.Clean_s(solid)
    brep = _brep(solid)  # before STEP, whose writer adds curves to the edges of planes
    step = step_file(solid, name)
    report["valid_in_step"] = report["valid"] and _is_one_solid(step)
    return Measured(report, {"npz": npz(mesh), "brep": brep, "step": step})


def _is_one_solid(step: bytes) -> bool:
    """Return whether who reads a STEP file gets one valid solid: STEP states no tolerances of edges, and some valid solids need theirs."""
    try:
        solids = solids_of(read_shape("step", step))
    except (ValueError, RuntimeError):
        return False
    return len(solids) == 1 and is_valid(solids[0])


def pieces(shape: TopoDS_Shape, *, deflection: float, angle: float) -> Measured:
    """Mesh all solids that a failed script had made, as one mesh, for a picture of its progress."""
    solids = [solid for solid in found(shape, TopAbs_SOLID) if _volume(solid).Mass() > EMPTY_MM3]
    meshes = [mesh for mesh in (tessellate(solid, deflection, angle) for solid in solids) if is_closed(mesh.triangles)]
    report = {"ok": True, "solids": len(meshes)}
    if not meshes:
        return Measured(report, {})
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    together = Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]).astype(np.int32),
        np.concatenate([np.full(len(mesh.face), place, np.int32) for place, mesh in enumerate(meshes)]),
    )
    return Measured(report, {"npz": npz(together)})


def properties(solid: TopoDS_Shape) -> Json:
    """Return volume, area, centre, inertia about the centre at density one, and bounding box, from the B-rep."""
    surface, volume = GProp_GProps(), _volume(solid)
    BRepGProp.SurfaceProperties_s(solid, surface)
    center, inertia, box = volume.CentreOfMass(), volume.MatrixOfInertia(), _box(solid)
    return {
        "volume_mm3": volume.Mass(),
        "area_mm2": surface.Mass(),
        "com_mm": _xyz(center),
        "inertia_mm5": [[inertia.Value(row, column) for column in (1, 2, 3)] for row in (1, 2, 3)],
        "bbox_mm": [[0.0] * 3, [0.0] * 3] if box.IsVoid() else [_xyz(box.CornerMin()), _xyz(box.CornerMax())],
    }


def self_intersection(solid: TopoDS_Shape) -> Json:
    """Return whether faces or edges of a solid intersect each other; None if the kernel gives up, as it does on some spline faces.

    A face that intersects itself, as in a sweep along too tight a bend, is not found. May take long: the caller limits the time.
    """
    analyzer = BOPAlgo_ArgumentAnalyzer()
    analyzer.SetShape1(solid)
    analyzer.ArgumentTypeMode = False
    analyzer.SmallEdgeMode = False
    analyzer.RebuildFaceMode = False
    analyzer.SelfInterMode = True
    analyzer.Perform()
    for result in analyzer.GetCheckResult():
        if result.GetCheckStatus() == BOPAlgo_CheckStatus.BOPAlgo_SelfIntersect:
            shapes = list(result.GetFaultyShapes1())
            return {"intersects_itself": True, "near_mm": _center(shapes[-1]) if shapes else None}
    return {"intersects_itself": None if analyzer.HasFaulty() else False}


def step_file(shape: TopoDS_Shape, name: str) -> bytes:
    """Return a shape as STEP AP214; the same shape gives the same bytes, because the header has a fixed time."""
    writer, stream = STEPControl_Writer(), io.BytesIO()
    Interface_Static.SetCVal_s("write.step.product.name", name)  # only defined once there is a writer
    writer.Transfer(shape, STEPControl_AsIs)
    writer.WriteStream(stream)
    head, data, body = stream.getvalue().partition(b"DATA;")
    body = body.replace(f"PRODUCT('{name} 1','{name} 1'".encode(), f"PRODUCT('{name}','{name}'".encode(), 1)
    return _STEP_TIME_FIELD.sub(rb"\g<1>" + STEP_TIME.encode() + b"'", head, count=1) + data + body


def compound(shapes: list[TopoDS_Shape]) -> TopoDS_Compound:
    """Return several shapes as one."""
    together, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(together)
    for shape in shapes:
        builder.Add(together, shape)
    return together


def binary(shape: TopoDS_Shape) -> bytes:
    """Return a shape in the form in which one process of the worker passes it to the next."""
    stream = io.BytesIO()
    BinTools.Write_s(shape, stream)
    return stream.getvalue()


def is_valid(shape: TopoDS_Shape) -> bool:
    """Return whether OCCT's check of the topology and geometry finds no fault."""
    return bool(BRepCheck_Analyzer(shape).IsValid())


def solids_of(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    """Return the solids of a shape, each once."""
    return list(found(shape, TopAbs_SOLID))


def to_json(report: Json) -> bytes:
    """Return one line of JSON; a number that is not finite becomes null, which no reader takes for a number."""
    return json.dumps(_finite(report), allow_nan=False, separators=(",", ":")).encode() + b"\n"


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return [_finite(item) for item in value] if isinstance(value, (list, tuple)) else value


def found(shape: TopoDS_Shape, kind: Any, avoid: Any = None) -> Iterator[TopoDS_Shape]:
    """Yield the sub-shapes of a kind, each once, in the kernel's order."""
    seen: set[Same] = set()
    explorer = TopExp_Explorer(shape, kind) if avoid is None else TopExp_Explorer(shape, kind, avoid)
    while explorer.More():
        current = explorer.Current()
        if (key := Same(current)) not in seen:
            seen.add(key)
            yield current
        explorer.Next()


def _volume(solid: TopoDS_Shape) -> GProp_GProps:
    volume = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid, volume)
    return volume


def _box(shape: TopoDS_Shape) -> Bnd_Box:
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, useTriangulation=False, useShapeTolerance=False)
    box.SetGap(0.0)
    return box


def _center(shape: TopoDS_Shape) -> list[float] | None:
    box = _box(shape)
    return None if box.IsVoid() else [(low + high) / 2 for low, high in zip(_xyz(box.CornerMin()), _xyz(box.CornerMax()), strict=True)]


def placed(shape: TopoDS_Shape, matrix: list[list[float]]) -> TopoDS_Shape:
    """Return a copy of a shape under a rigid motion or a reflection `(4, 4)`."""
    motion = gp_Trsf()
    motion.SetValues(*(value for row in matrix[:3] for value in row))
    return BRepBuilderAPI_Transform(shape, motion, theCopyGeom=True).Shape()


def _moved(solid: TopoDS_Shape, matrix: list[list[float]]) -> TopoDS_Shape:
    return TopoDS.Solid(placed(solid, matrix))


def npz(mesh: Mesh) -> bytes:
    """Return the bytes of an `.npz` file, the same under every version of Python and NumPy, whose `savez` differ."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, array in (("vertices", mesh.vertices), ("triangles", mesh.triangles), ("face", mesh.face)):
            content = io.BytesIO()
            np.lib.format.write_array(content, np.ascontiguousarray(array), version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", date_time=ZIP_TIME), content.getvalue())
    return stream.getvalue()


def _brep(solid: TopoDS_Shape) -> bytes:
    stream = io.BytesIO()
    version = TopTools_FormatVersion.TopTools_FormatVersion_VERSION_1
    BRepTools.Write_s(solid, stream, theWithTriangles=False, theWithNormals=False, theVersion=version)
    return stream.getvalue()


def _xyz(point: Any) -> list[float]:
    return [point.X(), point.Y(), point.Z()]
