"""Open a FreeCAD document in a new process and report its content: `job.json` in, `report.json` out, in the working folder.

The job names a file and steps, done in order: `solve`; `perturb`, which moves one part, solves, reports and puts
everything back; `turn`, which moves one part, solves and recomputes; `set`, which changes a parameter and recomputes; `look`, which reports; `save`; `verify`, which recomputes,
solves, saves, opens the file again and reports before and after. Nothing here imports articad: what is reported is judged
outside.
"""

from __future__ import annotations

import importlib.util
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part

Json = dict[str, Any]

_SHOWN = ("PartDesign::Body", "Part::Feature", "Part::Mirroring")  # what shows a part; a body may be made of mirror images
_PATIENCE = 300.0  # seconds for all drawings
_SAME = 1e-6  # mm, of dimensions, and of the distance of what touches
_SOLIDS, _EDGES = 5, 1000  # of a faulty part that are looked at


def main() -> None:
    """Read the job, do its steps, report."""
    job = json.loads(Path("job.json").read_text())
    document = App.openDocument(str(Path(job["file"]).resolve()), True)
    report: Json = {"version": list(App.Version()[:3]), "steps": []}
    for step in job["steps"]:
        report["steps"].append(_STEPS[step["do"]](document, step))
    Path("report.json").write_text(json.dumps(report))


def _assembly(document: Any) -> Any:
    (found,) = [item for item in document.Objects if item.TypeId == "Assembly::AssemblyObject"][:1]
    return found


def _parts(document: Any) -> dict[str, Any]:
    return {item.ArticadPart: item for item in document.Objects if "ArticadPart" in item.PropertiesList}


def _look(document: Any, _: Json) -> Json:
    """Report the content of the document, and FreeCAD's view of it."""
    parts = _parts(document)
    return {
        "version": list(App.Version()[:3]),
        "articad": importlib.util.find_spec("articad") is not None,
        "parts": {name: _seven(item.Placement) for name, item in parts.items()},
        "connectors": {name: _connectors(item) for name, item in parts.items()},
        "boxes": {name: _box(item) for name, item in parts.items()},
        "volumes": {name: _volume(item) for name, item in parts.items()},
        "masses": {name: _mass(item) for name, item in parts.items()},
        "bill": _bill(document),
        "editable": {item.Label: _editable(item) for item in document.Objects if item.TypeId == "App::VarSet"},
        "invalid": [item.Name for item in document.Objects if "Invalid" in item.State],
        "touched": [item.Name for item in document.Objects if "Touched" in item.State],
        "joints": {item.Name: str(item.JointType) for item in document.Objects if hasattr(item, "JointType")},
        "limits": {item.Name: _limits(item) for item in document.Objects if hasattr(item, "JointType")},
        "expressions": sorted(
            f"{item.Name}.{path.lstrip('.')} = {text}" for item in document.Objects for path, text in item.ExpressionEngine
        ),
        "visible": sorted(name for name, item in parts.items() if item.Visibility),
        "meshes": {name: found for name, item in parts.items() if (found := _mesh(item)) is not None},
        "labels": {item.Name: item.Label for item in document.Objects},
        "parameters": _parameters(document.getObject("Parameters")),
        "objects": sorted(f"{item.TypeId} {item.Name}" for item in document.Objects),
        "materials": {name: _material(item) for name, item in parts.items()},  # last: to ask for a density touches the object
    }


def _editable(values: Any) -> list[str]:
    """Return the values of a VarSet that a user can change and that follow nothing."""
    own = [name for name in values.PropertiesList if name[:2] in ("p_", "d_") and "ReadOnly" not in values.getEditorMode(name)]
    return sorted(set(own) - {path.lstrip(".") for path, _ in values.ExpressionEngine})


def _bill(document: Any) -> list[list[str]]:
    """Return the rows of the bill of materials."""
    sheets = [item for item in document.Objects if item.TypeId == "Assembly::BomObject"]
    cells = {cell: str(sheet.get(cell)) for sheet in sheets for cell in sheet.getUsedCells()}
    rows = sorted({int(cell[1:]) for cell in cells})
    return [[cells.get(f"{column}{row}", "") for column in "ABCDEF"] for row in rows]


def _parameters(values: Any) -> Json:
    """Return the group, the tooltip and whether it can be edited of each parameter."""
    names = [] if values is None else [name for name in values.PropertiesList if name.startswith("p_")]
    return {
        name: [values.getGroupOfProperty(name), values.getDocumentationOfProperty(name), "ReadOnly" not in values.getEditorMode(name)]
        for name in names
    }


def _connectors(part: Any) -> Json:
    container = part.LinkedObject if part.TypeId == "App::Link" else part
    return {item.ArticadConnector: _seven(item.Placement) for item in container.Group if "ArticadConnector" in item.PropertiesList}


def _shape(part: Any) -> Any:
    item = _body(part)
    return None if item is None else item.Shape


def _body(part: Any) -> Any:
    container = part.LinkedObject if part.TypeId == "App::Link" else part
    held = {item.TypeId: item for item in container.Group if item.TypeId in _SHOWN}
    return next((held[kind] for kind in _SHOWN if kind in held), None)


def _material(part: Any) -> list[Any] | None:
    """Return the card of a part's material in FreeCAD's library: its name and its density [kg/m³]."""
    body = _body(part)
    if body is None:
        return None
    card = body.ShapeMaterial
    density = card.getPhysicalValue("Density").getValueAs("kg/m^3").Value if card.hasPhysicalProperty("Density") else None
    return [card.Name, density]


def _box(part: Any) -> list[list[float]] | None:
    """Return the exact bounding box in the part's own frame [mm]."""
    shape = _shape(part)
    if shape is None or shape.isNull():
        return None
    box = shape.optimalBoundingBox(False)
    return [[box.XMin, box.YMin, box.ZMin], [box.XMax, box.YMax, box.ZMax]]


def _volume(part: Any) -> float | None:
    shape = _shape(part)
    return None if shape is None or shape.isNull() else shape.Volume


def _mesh(part: Any) -> Json | None:
    container = part.LinkedObject if part.TypeId == "App::Link" else part
    for item in container.Group:
        if item.TypeId == "Mesh::Feature":
            return {"volume": item.Mesh.Volume, "closed": item.Mesh.isSolid()}
    return None


def _limits(joint: Any) -> Json:
    """Return the enabled limits of a joint, in degrees and mm."""
    names = ("AngleMin", "AngleMax", "LengthMin", "LengthMax")
    return {name: float(getattr(joint, name)) for name in names if getattr(joint, f"Enable{name}", False)}


def _solve(document: Any, _: Json) -> Json:
    """Run FreeCAD's solver, and report the poses of the parts."""
    code = _assembly(document).solve()
    return {"code": code, "parts": {name: _seven(item.Placement) for name, item in _parts(document).items()}}


def _perturb(document: Any, step: Json) -> Json:
    """Move one part by `by`, solve `times` times, report the last state and those before, and restore everything."""
    parts = _parts(document)
    before = {name: item.Placement for name, item in parts.items()}
    moved = parts[step["part"]]
    by = App.Placement(App.Vector(*step["by"][:3]), App.Rotation(*step["by"][3:]))
    moved.Placement = moved.Placement * by
    solved = [_solve(document, step) for _ in range(step.get("times", 1))]
    report = solved[-1] | {"before": solved[:-1]}
    for name, item in parts.items():
        item.Placement = before[name]
    return report


def _turn(document: Any, step: Json) -> Json:
    """Move one part by `by`, solve, recompute, and report."""
    part = _parts(document)[step["part"]]
    part.Placement = part.Placement * App.Placement(App.Vector(*step["by"][:3]), App.Rotation(*step["by"][3:]))
    code = _assembly(document).solve()
    document.recompute()
    return _look(document, step) | {"code": code}


def _set(document: Any, step: Json) -> Json:
    """Change parameters of the VarSet, recompute, and report."""
    for name, value in step["values"].items():
        setattr(document.getObject("Parameters"), f"p_{name}", value)
    document.recompute()
    document.recompute()
    code = _assembly(document).solve()
    return _look(document, step) | {"code": code}


def _save(document: Any, step: Json) -> Json:
    document.saveAs(str(Path(step["file"]).resolve()))
    return {}


def _verify(document: Any, _: Json) -> Json:
    """Recompute, measure, solve and save; then open what was saved and do the same again."""
    first = _measured(document)
    saved = str(Path("verified.FCStd").resolve())
    for other in _linked(document):
        other.save()
    document.saveAs(saved)
    for name in list(App.listDocuments()):
        App.closeDocument(name)
    again = App.openDocument(saved, True)
    return {"first": first, "again": _measured(again)}


def _linked(document: Any) -> list[Any]:
    """Return the other documents that FreeCAD opened, because this one links to them."""
    return [other for other in App.listDocuments().values() if other.Name != document.Name]


def _measured(document: Any) -> Json:
    """Return what stands in the document as it was opened, after a recompute, and after its joints are solved."""
    opened = {name: _shape_now(item) for name, item in _parts(document).items()}
    objects = [item for held in (*_linked(document), document) for item in held.Objects]
    for item in objects:
        item.touch()
    for held in (*_linked(document), document):
        held.recompute()
    drawings = _drawings(document)
    placed = {name: _seven(item.Placement) for name, item in _parts(document).items()}
    return {
        "opened": opened,
        "drawings": drawings,
        "recomputed": {name: _shape_now(item) for name, item in _parts(document).items()},
        "placed": placed,
        "invalid": [f"{item.Name} ({item.getStatusString()})" for item in objects if "Invalid" in item.State],
        "solved": _solve(document, {}),
    }


def _drawings(document: Any) -> dict[str, list[str]]:
    """Wait until FreeCAD has projected all views; return what each page lacks: edges of views, and values of dimensions."""
    pages = [item for item in document.Objects if item.TypeId == "TechDraw::DrawPage"]
    views = [item for item in document.Objects if item.TypeId == "TechDraw::DrawViewPart"]
    if not pages:
        return {}
    from PySide import QtCore  # noqa: PLC0415 - only if there are drawings

    application = QtCore.QCoreApplication.instance() or QtCore.QCoreApplication([])
    end = time.monotonic() + _PATIENCE
    while time.monotonic() < end and not all(view.getVisibleEdges() for view in views):
        application.processEvents()
        time.sleep(0.01)
    for item in document.Objects:
        if item.TypeId == "TechDraw::DrawViewDimension":
            item.touch()
    document.recompute()
    return {page.Label: list(_lacking(page)) for page in pages}


def _lacking(page: Any) -> Iterator[str]:
    for item in page.Views:
        if item.TypeId == "TechDraw::DrawViewPart" and not item.getVisibleEdges():
            yield f"view {item.Label} shows nothing"
        if item.TypeId == "TechDraw::DrawViewDimension" and not abs(item.getRawValue() - item.ArticadValue) <= _SAME:
            yield f"dimension {item.Label} is {item.getRawValue():.9g}, not {item.ArticadValue:.9g}"


def _shape_now(part: Any) -> Json:
    """Return whether a part has a shape, whether that is valid, its volume and its centre in the part's own frame [mm]."""
    shape, mass = _shape(part), _mass(part)
    if shape is None:
        mesh = _mesh(part)
        return {"kind": "nothing"} if mesh is None else {"kind": "mesh", "volume": mesh["volume"], "mass": mass}
    if shape.isNull():
        return {"kind": "null"}
    solids = shape.Solids
    center = solids[0].CenterOfMass if len(solids) == 1 else App.Vector()
    row = {"kind": "shape", "valid": shape.isValid(), "solids": len(solids), "volume": shape.Volume, "center": list(center), "mass": mass}
    return row if row["valid"] and len(solids) == 1 else row | {"faults": list(_faults(solids))}


def _faults(solids: list[Any]) -> Iterator[str]:
    """Yield which solids of a part are invalid, touch themselves along an edge, or touch another one."""
    for number, solid in enumerate(solids[:_SOLIDS], start=1):
        size = f"solid {number}, of {abs(solid.Volume):.6g} mm\u00b3 about ({_point(solid.CenterOfMass)})"
        if not solid.isValid():
            yield f"{size}, is invalid"
        for edge in solid.Edges[:_EDGES]:
            if len(solid.ancestorsOfType(edge, Part.Face)) > 2:
                yield f"{size}, touches itself along an edge at ({_point(edge.CenterOfMass)})"
                break
        for other, second in enumerate(solids[number:_SOLIDS], start=number + 1):
            distance, points, _ = solid.distToShape(second)
            if distance < _SAME:
                yield f"{size}, touches solid {other} at ({_point(points[0][0])})"


def _point(vector: Any) -> str:
    return ", ".join(f"{value:.4g}" for value in vector)


def _mass(part: Any) -> float | None:
    """Return the mass that the part states [kg]."""
    return float(part.ArticadMass.getValueAs("kg")) if "ArticadMass" in part.PropertiesList else None


def _seven(placement: Any) -> list[float]:
    return [*placement.Base, *placement.Rotation.Q]


_STEPS = {"look": _look, "solve": _solve, "perturb": _perturb, "turn": _turn, "set": _set, "save": _save, "verify": _verify}

main()
