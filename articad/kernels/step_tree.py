"""The products of a STEP assembly with their solids and poses. Runs inside the sandbox."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from itertools import count
from typing import Any

import numpy as np
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.collections import Sequence_TDF_Label
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from articad.aliases import Json
from articad.kernels import measure
from articad.kernels.tessellation import Mesh, tessellate

MOST_DEPTH = 50  # levels of nested products
MOST_PARTS = 2000
MOST_PLACED = 20_000  # instances of products, those of assemblies included
_GENERATED = re.compile(r"=>|NAUO\d*$|\d*$")  # names of instances in files of programs that name only products


def read(content: bytes, *, deflection: float, angle: float) -> tuple[list[Json], bytes]:
    """Return a row for each solid or loose piece, and one mesh whose face indices are the rows' numbers.

    Args:
        content: The file.
        deflection: Linear deflection of the meshes [mm].
        angle: Angular deflection of the meshes [rad].

    Raises:
        ValueError: If it is not a STEP file, or contains no shape.
    """
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(namemode=True)
    if reader.ReadStream("assembly", io.BytesIO(content)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ValueError("this is not a STEP file")
    reader.Transfer(document)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    labels = Sequence_TDF_Label()
    tool.GetFreeShapes(labels)
    rows: list[Json] = []
    meshes: list[Mesh] = []
    placed = count(1)
    for label in _sequence(labels):
        for path, product, instance, shape in _leaves(label, TopLoc_Location(), (), placed):
            for piece, loose in _pieces(shape):
                if len(rows) >= MOST_PARTS:
                    raise ValueError(f"it holds more than {MOST_PARTS} parts")
                rows.append(_row(path, product, instance, piece, loose=loose))
                meshes.append(tessellate(piece, deflection, angle))
    if not rows:
        raise ValueError("it holds no shape")
    return rows, measure.npz(_together(meshes))


def _leaves(label: Any, place: Any, path: tuple[str, ...], placed: Iterator[int]) -> Iterator[tuple[tuple[str, ...], str, str, Any]]:
    """Yield the shapes that are not assemblies, placed, with the products above them, their own product, and the instance's name.

    The instance's name is empty if the product has only one instance, or if a program has numbered its instances. `placed` counts the
    instances: products without a shape that each hold the next one twice would be 2⁵⁰.
    """
    if len(path) > MOST_DEPTH:
        raise ValueError(f"its products are more than {MOST_DEPTH} deep")
    if next(placed) > MOST_PLACED:
        raise ValueError(f"it places more than {MOST_PLACED} products")
    here = place.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label)) if XCAFDoc_ShapeTool.IsReference_s(label) else place
    instance, target = _name(label), label
    if XCAFDoc_ShapeTool.IsReference_s(label):
        target = TDF_Label()
        XCAFDoc_ShapeTool.GetReferredShape_s(label, target)
    product = _name(target) or instance
    if XCAFDoc_ShapeTool.IsAssembly_s(target):
        components = Sequence_TDF_Label()
        XCAFDoc_ShapeTool.GetComponents_s(target, components)
        for component in _sequence(components):
            yield from _leaves(component, here, (*path, product), placed)
        return
    shape = XCAFDoc_ShapeTool.GetShape_s(target)
    if not shape.IsNull():
        shared = XCAFDoc_ShapeTool.GetUsers_s(target, Sequence_TDF_Label()) > 1
        own = instance if shared and not _GENERATED.match(instance) else ""
        yield path, product, own, shape.Moved(here) if not here.IsIdentity() else shape


def _pieces(shape: TopoDS_Shape) -> Iterator[tuple[TopoDS_Shape, bool]]:
    """Yield the solids of a shape, then all faces that belong to no solid as one piece."""
    solids = list(measure.found(shape, TopAbs_SOLID))
    for solid in solids:
        yield solid, False
    loose = list(measure.found(shape, TopAbs_FACE, avoid=TopAbs_SOLID))
    if loose:
        yield measure.compound(loose), True


def _row(path: tuple[str, ...], product: str, instance: str, piece: TopoDS_Shape, *, loose: bool) -> Json:
    valid = not loose and bool(BRepCheck_Analyzer(piece).IsValid()) and measure.properties(piece)["volume_mm3"] >= measure.EMPTY_MM3
    return {
        "path": list(path),
        "product": product,
        "instance": instance,
        "valid": valid,
        "loose": loose,
        "faces": sum(1 for _ in measure.found(piece, TopAbs_FACE)),
    }


def _together(meshes: list[Mesh]) -> Mesh:
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts[:-1], strict=True)]).astype(np.int32),
        np.concatenate([np.full(len(mesh.triangles), number, np.int32) for number, mesh in enumerate(meshes)]),
    )


def _name(label: Any) -> str:
    attribute = TDataStd_Name()
    if label.FindAttribute(TDataStd_Name.GetID_s(), attribute):
        return str(attribute.Get().ToExtString())
    return ""


def _sequence(labels: Any) -> Iterator[Any]:
    for index in range(1, labels.Length() + 1):
        yield labels.Value(index)
