"""Run inside FreeCAD: copy FreeCAD's own example of an assembly here, and report what FreeCAD finds in it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part
import UtilsAssembly


def main() -> None:
    """Leave example.FCStd and told.json."""
    found = next(folder for root in ("/usr/share/freecad", App.getResourceDir()) for folder in Path(root).rglob("AssemblyExample.FCStd"))
    shutil.copyfile(found, "example.FCStd")
    document = App.openDocument(str(Path("example.FCStd").resolve()))
    (assembly,) = [item for item in document.Objects if item.TypeId == "Assembly::AssemblyObject"]
    joints = [item for item in document.Objects if hasattr(item, "JointType")]
    grounded = next(item for item in document.Objects if hasattr(item, "ObjectToGround"))
    parts = [item for item in assembly.Group if item.TypeId == "App::Link"]
    told = {
        "parts": {item.Label: [_seven(item.Placement), Part.getShape(item).Volume] for item in parts},
        "joints": {item.Label: [str(item.JointType), [_seven(_frame(item, number)) for number in (1, 2)]] for item in joints},
        "ground": grounded.ObjectToGround.Label,
    }
    Path("told.json").write_text(json.dumps(told))


def _frame(joint: Any, number: int) -> Any:
    return UtilsAssembly.getJcsGlobalPlc(getattr(joint, f"Placement{number}"), getattr(joint, f"Reference{number}"))


def _seven(placement: Any) -> list[float]:
    return [*placement.Base, *placement.Rotation.Q]


main()
