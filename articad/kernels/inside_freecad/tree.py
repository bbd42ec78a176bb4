"""Make a tree of features, edit its dimensions, and measure it: `job.json` in, `part.FCStd` and `report.json` out, in the working folder.

Runs inside FreeCAD 1.0 or later and never imports articad. The job lists objects of the Part workbench, operands first, with the
expressions of their properties over the VarSet `Dimensions`; the last object is the solid. It becomes the base of a PartDesign::Body, so
that the part looks like one whose script was written for FreeCAD.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part
from numbered import FIRST_OF_PART, numbered_document  # type: ignore[import-not-found]

Json = dict[str, Any]

NEAR_MM = 1e-4  # by which the centre of an edge may differ between two kernels that place a seam differently


class UnmadeTreeError(Exception):
    """The tree cannot be made; the message says why."""


def main() -> None:
    """Read the job, make the tree, measure it at each variation, save it, report."""
    job = json.loads(Path("job.json").read_text())
    report: Json = {"version": list(App.Version()[:3])}
    try:
        report |= _made(job)
    except UnmadeTreeError as error:
        report["problem"] = str(error)
    Path("report.json").write_text(json.dumps(report))


def _made(job: Json) -> Json:
    document = numbered_document(str(Path("seed.FCStd").resolve()), "part", "Dimensions", FIRST_OF_PART)
    document.UndoMode = 0
    values = document.getObject("Dimensions")
    for name, value in job["dimensions"].items():
        values.addProperty("App::PropertyFloat", f"d_{name}", "Dimensions", name)
        setattr(values, f"d_{name}", float(value))
    for name, text in job["derived"].items():
        values.addProperty("App::PropertyFloat", name, "Derived", text)
        values.setExpression(name, text)
        values.setEditorMode(name, ["ReadOnly"])
    document.recompute()
    made: list[Any] = []
    for row in job["objects"]:
        made.append(_object(document, row, made))
    body = document.addObject("PartDesign::Body", "Body")
    body.BaseFeature = made[-1]
    document.recompute()
    nominal = _measured(document, body)
    varied = []
    for dimensions in job["variations"]:
        if not dimensions:  # the script builds nothing there
            varied.append({"ok": False})
            continue
        for name, value in dimensions.items():
            setattr(values, f"d_{name}", float(value))
        document.recompute()
        varied.append(_measured(document, body))
        for name in dimensions:
            setattr(values, f"d_{name}", float(job["dimensions"][name]))
    document.recompute()
    again = _measured(document, body)
    for item in document.Objects:
        item.purgeTouched()
    document.saveAs(str(Path("part.FCStd").resolve()))
    return {"nominal": nominal, "varied": varied, "again": again}


def _object(document: Any, row: Json, made: list[Any]) -> Any:
    item = document.addObject(row["type"], row["name"])
    item.Label2 = row["note"]
    for name, value in row["set"].items():
        setattr(item, name, App.Vector(*value) if isinstance(value, list) else value)
    for name, links in row["links"].items():
        setattr(item, name, [made[link] for link in links] if isinstance(links, list) else made[links])
    if row["nodes"] is not None:
        item.Nodes = [App.Vector(x, y, 0) for x, y in row["nodes"]]
    if row["placement"] is not None:
        item.Placement = App.Placement(App.Vector(*row["placement"][:3]), App.Rotation(*row["placement"][3:]))
    for name, text in row["expressions"].items():
        item.setExpression(name, text)
    if row["edges"] is not None:
        document.recompute()
        numbers = [_edge(item.Base.Shape, *edge) for edge in row["edges"]["at"]]
        item.Edges = [(number, row["edges"]["size"], row["edges"]["size"]) for number in numbers]
        if row["edges"]["expression"]:
            size = row["edges"]["expression"]
            item.setExpression("Edges", f"list({'; '.join(f'tuple({number}; {size}; {size})' for number in numbers)})")
    document.recompute()
    if "Invalid" in item.State or item.Shape.isNull():
        raise UnmadeTreeError(f"FreeCAD cannot compute {row['note'] or row['name']}")
    return item


def _edge(shape: Any, x: float, y: float, z: float, length: float) -> int:
    """Return the number of the one edge with this centre and length."""
    wanted = App.Vector(x, y, z)
    near = [
        number
        for number, edge in enumerate(shape.Edges, start=1)
        if edge.CenterOfMass.distanceToPoint(wanted) < NEAR_MM and abs(edge.Length - length) < NEAR_MM
    ]
    if len(near) != 1:
        raise UnmadeTreeError(f"FreeCAD's solid has {len(near)} edges where the script picks one")
    return near[0]


def _measured(document: Any, body: Any) -> Json:
    shape, invalid = body.Shape, [item.Label for item in document.Objects if "Invalid" in item.State]
    if shape.isNull() or len(shape.Solids) != 1 or invalid:
        return {"ok": False, "invalid": invalid[:5]}
    solid = shape.Solids[0]
    inertia = solid.MatrixOfInertia
    return {
        "ok": shape.isValid(),
        "volume_mm3": solid.Volume,
        "area_mm2": solid.Area,
        "com_mm": list(solid.CenterOfMass),
        "inertia_mm5": [[getattr(inertia, f"A{row}{column}") for column in (1, 2, 3)] for row in (1, 2, 3)],
        "faces": len(solid.removeSplitter().Faces),
    }


_ = Part  # makes FreeCAD load the types of objects
main()
