"""Run inside FreeCAD: every VarSet of a document and of those that it links to, as a user sees it. `job.json` in, `report.json` out."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import FreeCAD as App


def main() -> None:
    """Report label, and group and read-only mark of each value, by document and object; links show the values of what they link to."""
    job = json.loads(Path("job.json").read_text())
    App.openDocument(str(Path(job["file"]).resolve()), True)  # noqa: FBT003 - hidden
    report = {
        f"{name}#{item.Name}": [item.Label, _values(item)]
        for name, document in App.listDocuments().items()
        for item in document.Objects
        if item.getLinkedObject().TypeId == "App::VarSet"
    }
    Path("report.json").write_text(json.dumps({"steps": [report]}))


def _values(item: Any) -> dict[str, list[Any]]:
    held = item.getLinkedObject()
    names = [name for name in held.PropertiesList if name[:2] in ("p_", "d_")]
    return {name: [held.getGroupOfProperty(name), "ReadOnly" in item.getEditorMode(name)] for name in names}


main()
