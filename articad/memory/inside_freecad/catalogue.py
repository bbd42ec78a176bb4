"""Extract FreeCAD's own documentation: run inside FreeCAD, in a process of its own; writes `/work/catalogue.json`.

FreeCAD documents each property and its values, but not the purpose of a feature: PURPOSES adds that.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part

Json = dict[str, Any]

PURPOSES = {
    "Boolean": "Fuse, cut or intersect the body with another body.",
    "Chamfer": "Bevel edges: a flat cut at an angle along each edge.",
    "CoordinateSystem": "Datum frame with origin and axes: marks a place, such as where another part is connected.",
    "Draft": "Slant faces by an angle about a neutral plane, so that a moulded or cast part comes out of its mould.",
    "Fillet": "Round edges with a radius.",
    "Groove": "Cut away what a sketch sweeps when it turns about an axis: a ring-shaped groove.",
    "Hole": "Drill round holes at the circles of a sketch: depth, thread, counterbore for a socket screw's head, countersink for a flat head.",
    "Line": "Datum line, an axis to turn or to pattern about.",
    "LinearPattern": "Repeat features in a row, at equal distances along a direction.",
    "Mirrored": "Mirror features about a plane: the other half of a symmetric part.",
    "MultiTransform": "Chain patterns and mirrors: rows and columns, a grid.",
    "Pad": "Extrude a sketch: raise a flat outline to a solid of a length, add material.",
    "Pocket": "Cut a sketch's outline into the solid, to a depth or through all: holes, slots, recesses.",
    "Plane": "Datum plane at an offset or angle: a working plane to draw a sketch on.",
    "Point": "Datum point.",
    "PolarPattern": "Repeat features round an axis, evenly on a circle.",
    "Revolution": "Turn a sketch's outline about an axis: a round, lathe-turned solid.",
    "Scaled": "Scale features, as a step of a MultiTransform.",
    "ShapeBinder": "Refer to another body's geometry.",
    "SubShapeBinder": "Refer to other geometry, also across bodies.",
    "Thickness": "Hollow the solid out to a shell of thin walls, open at the selected faces.",
}
# Features that add material, and the features of the same name that remove it.
SHAPES = {
    "Box": "cuboid, block with three side lengths",
    "Cylinder": "cylinder, round rod",
    "Sphere": "sphere, ball",
    "Cone": "cone, tapered round pin with two radii",
    "Ellipsoid": "ellipsoid, egg shape with three radii",
    "Torus": "torus, ring of round cross-section such as an O-ring",
    "Prism": "regular prism, such as a hexagon nut: number of sides, circumradius, height",
    "Wedge": "wedge, block with slanted sides",
    "Loft": "loft, smooth transition between sketches at different heights, such as square to circle",
    "Pipe": "sweep of a sketch along a path, bent or straight: pipe, wire, handle, moulding",
    "Helix": "sweep of a sketch along a helix: coil spring, screw thread, auger",
}
for _shape, _words in SHAPES.items():
    PURPOSES[f"Additive{_shape}"] = f"Add material: {_words}."
    PURPOSES[f"Subtractive{_shape}"] = f"Cut material away: {_words}."

_HIDDEN = {"Base", "", "Attachment"}  # groups of properties that no script sets by hand
_SHARED = {"Refine", "AllowMultiFace", "AttacherEngine", "AttacherType", "MapMode", "MapReversed", "MapPathParameter"}


def features() -> Iterator[Json]:
    """Yield an entry for each feature of a body, with its properties and their values."""
    document = App.newDocument("Catalogue")
    body = document.addObject("PartDesign::Body", "Body")
    for kind in sorted(set(document.supportedTypes())):
        purpose = PURPOSES.get(kind.removeprefix("PartDesign::"))
        if not kind.startswith("PartDesign::") or purpose is None:
            continue
        feature = body.newObject(kind, "Item")
        lines = []
        for name in feature.PropertiesList:
            if feature.getGroupOfProperty(name) in _HIDDEN or name in _SHARED or "ReadOnly" in feature.getPropertyStatus(name):
                continue
            of_kind = feature.getTypeIdOfProperty(name).removeprefix("App::Property")
            values = feature.getEnumerationsOfProperty(name) or []
            choices = f" one of {', '.join(map(str, values))}" if 0 < len(values) <= 12 else ""
            lines.append(f"  .{name}: {of_kind}{choices}. {feature.getDocumentationOfProperty(name).strip()}".replace("\n", " "))
        signature = f'part.body.newObject("{kind}", name)'
        yield {"name": kind, "signature": signature, "summary": purpose, "text": "\n".join([purpose, signature, *lines])[:2500]}


def module() -> Iterator[Json]:
    """Yield an entry for each geometry class and maker of the module Part, and for the queries of a shape."""
    for name in dir(Part):
        item = getattr(Part, name)
        text = (getattr(item, "__doc__", None) or "").strip()
        if not name.startswith("_") and callable(item) and text and "Error" not in name and "Extension" not in name:
            yield _of_module(f"Part.{name}", text)
    for owner, attributes in ((Part.Shape, dir(Part.Shape)), (App.BoundBox, ["XLength", "Center", "isInside"])):
        for name in attributes:
            text = (getattr(getattr(owner, name), "__doc__", None) or "").strip()
            if not name.startswith(("_", "export", "import", "dump", "read", "write", "ancestors")) and text:
                yield _of_module(f"Part.Shape.{name}" if owner is Part.Shape else f"Base.BoundBox.{name}", text)


def _of_module(name: str, text: str) -> Json:
    first, *rest = text.split("\n")
    signature = first.split(" -- ")[0].strip() if "(" in first else name
    summary = " ".join((first.split(" -- ")[-1], *rest)).strip()
    return {"name": name, "signature": signature[:200], "summary": " ".join(summary.split())[:300], "text": text[:1500]}


Path("/work/catalogue.json").write_text(
    json.dumps({"version": ".".join(App.Version()[:3]), "entries": [*features(), *module()]}), encoding="utf-8"
)
