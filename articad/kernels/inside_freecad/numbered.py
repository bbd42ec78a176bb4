"""Documents whose objects have the same numbers each time. Every program inside FreeCAD can import this module."""

from __future__ import annotations

import re
import zipfile
from typing import Any

import FreeCAD as App

FIRST_OF_PART, FIRST_OF_ASSEMBLY = 10_000, 100_000  # beyond 5000, the end of FreeCAD's own random start


def numbered_document(path: str, name: str, values: str, first: int) -> Any:
    """Return a document whose objects are numbered from `first`, with a VarSet.

    FreeCAD starts at a random number and names edges and faces by it; a document that is opened continues with its own.

    Args:
        path: Where the document is saved and opened again.
        name: Its label.
        values: Name of the VarSet.
        first: The first number.
    """
    fresh = App.newDocument(name)
    fresh.addObject("App::VarSet", values)
    fresh.saveAs(path)
    App.closeDocument(fresh.Name)
    with zipfile.ZipFile(path) as archive:
        files = {entry: archive.read(entry) for entry in archive.namelist()}
    number = rb'(name="%s" id=")\d+' % values.encode()
    files["Document.xml"] = re.sub(number, rb"\g<1>%d" % first, files["Document.xml"])
    with zipfile.ZipFile(path, "w") as archive:
        for entry, content in files.items():
            archive.writestr(entry, content)
    return App.openDocument(path)
