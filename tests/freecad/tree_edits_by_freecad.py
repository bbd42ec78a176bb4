"""Run inside FreeCAD: edit a parameter and a feature of a document with traced feature trees, in whichever file they are."""

from __future__ import annotations

import json
from pathlib import Path

import FreeCAD as App


def main() -> None:
    """Set p_a to 43 mm and the radius of the first cylinder to 7 mm, in place of its expression; save all files."""
    App.openDocument(str(Path(json.loads(Path("job.json").read_text())["file"]).resolve()))
    documents = list(App.listDocuments().values())
    items = [item for document in documents for item in document.Objects]
    parameters = next(item for item in items if item.TypeId == "App::VarSet" and "p_b" in item.PropertiesList)
    cylinder = next(item for item in items if item.TypeId == "Part::Cylinder")
    parameters.p_a = 43.0
    cylinder.setExpression("Radius", None)
    cylinder.Radius = 7.0
    for document in (*documents, *documents):
        document.recompute()
    for document in documents:
        document.save()
    Path("done.json").write_text(json.dumps(cylinder.Name))


main()
