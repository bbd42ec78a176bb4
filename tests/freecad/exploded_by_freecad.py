"""Explode an assembly by FreeCAD's own code: `it.FCStd` in, `exploded.json` out; runs inside FreeCAD."""

from __future__ import annotations

import builtins
import json
import os
from pathlib import Path
from typing import Any

import FreeCAD as App
from PySide import QtCore

vars(builtins)["QtCore"] = QtCore  # without a window, the module of exploded views does not import it


def main() -> None:
    import CommandCreateView  # noqa: F401 - before the document, whose objects are of its classes

    document = App.openDocument(str(Path("it.FCStd").resolve()))
    (view,) = [item for item in document.Objects if item.Label == "Exploded view"]
    before = placed(document)
    view.Proxy.applyMoves(view, App.Vector(), 100.0)
    report = {"before": before, "after": placed(document), "assembly": view.Proxy.getAssembly(view) is not None}
    Path("exploded.json").write_text(json.dumps(report))


def placed(document: Any) -> dict[str, list[float]]:
    parts = [item for item in document.Objects if "ArticadPart" in item.PropertiesList]
    return {item.ArticadPart: [*item.Placement.Base, *item.Placement.Rotation.Q] for item in parts}


main()
os._exit(0)  # FreeCAD 1.0 with Qt imported but no window never ends by itself
