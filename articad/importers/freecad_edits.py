"""The edits of a FreeCAD document that articad wrote: each difference from what was written."""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from articad.export.freecad_content import Content

Kind = Literal[
    "parameter",  # a value of the VarSet Parameters
    "dimension",  # a value of a part's VarSet
    "expression",
    "feature",  # a property of a feature, a constraint of a sketch, a cell of a sheet
    "added",  # an object
    "deleted",
    "label",
    "connector",
    "joint",
    "limit",
    "ground",
    "moved",  # a part; whatever else is edited moves parts too
    "material",
    "group",  # members that stand in another group now
    "note",  # a description, or a material of FreeCAD's library
]
SAME = 1e-9  # numbers, relative to the larger one or to 1
_LIMIT = re.compile(r"(Enable)?(Angle|Length)(Min|Max)")


@dataclass(frozen=True)
class Edit:
    """One difference.

    Attributes:
        kind: Of what.
        object: FreeCAD's name of the object.
        label: The object's label as it was written, or as it is now for a new one.
        type: FreeCAD's type of the object.
        key: The property; empty for a whole object.
        before: Its value as written; None for what is new.
        now: Its value in the document; None for what is gone.
    """

    kind: Kind
    object: str
    label: str
    type: str
    key: str = ""
    before: Any = None
    now: Any = None

    def __str__(self) -> str:
        named = f"{self.label or self.object} ({self.type.rpartition('::')[2]})"
        if self.kind == "added":
            return f"{named} was added."
        if self.kind == "deleted":
            return f"{named} was deleted."
        if self.kind == "group":
            gone, come = (
                [member for member in one if member not in other]
                for one, other in ((self.before or [], set(self.now or ())), (self.now or [], set(self.before or ())))
            )
            return f"{named}: {', '.join(gone) or 'nothing'} left the group, {', '.join(come) or 'nothing'} joined it."
        if self.kind == "label":
            return f"{self.type.rpartition('::')[2]} {self.before!r} is now labelled {self.now!r}."
        return f"{named}: {self.key} changed from {_said(self.before)} to {_said(self.now)}."


def edits(before: Content, now: Content) -> list[Edit]:
    """Return the differences between a document as it was written and as it is now.

    A value that an unchanged expression determines is not an edit: it follows from another edit.
    """
    staying = before.keys() & now.keys()
    found = [edit for name, held in now.items() if name in before for edit in _changes(name, before[name], held, staying)]
    gone = [Edit("deleted", name, held["label"], held["type"]) for name, held in before.items() if name not in now]
    new = [Edit("added", name, held["label"], held["type"]) for name, held in now.items() if name not in before]
    return [*found, *gone, *new]


def _changes(name: str, before: Any, now: Any, staying: set[str]) -> Iterator[Edit]:
    kind, label = before["type"], before["label"]

    def edit(what: Kind, key: str, old: Any, new: Any) -> Edit:
        return Edit(what, name, label, kind, key, old, new)

    if now["type"] != kind:
        yield edit("feature", "type", kind, now["type"])
        return
    if now["label"] != label:
        yield edit("label", "Label", label, now["label"])
    bound = {path: text for path, text in before["expressions"].items() if now["expressions"].get(path) == text}
    roots = _roots(bound)
    for path in sorted({*before["expressions"], *now["expressions"]}):
        if path not in bound:
            yield edit("expression", path, before["expressions"].get(path), now["expressions"].get(path))
    for key in sorted(before["values"].keys() | now["values"].keys()):
        old, new = before["values"].get(key), now["values"].get(key)
        if key == "Group":  # what was added or deleted is an edit of its own
            old, new = ([member for member in held or () if member in staying] for held in (old, new))
        if _same(old, new) or _is_within(key, roots) or (key in now["expressions"] and key not in bound):
            continue
        if (old is None or new is None) and not (kind == "App::VarSet" or key.startswith(("Constraints.", "cells."))):
            continue  # a property that one version of FreeCAD has and another has not
        yield edit(_kind(name, kind, key), key, old, new)


def _roots(paths: Iterable[str]) -> list[str]:
    """Return paths in order, each with a dot at its end, without those that begin with another one."""
    found: list[str] = []
    for path in sorted(f"{path}." for path in paths):
        if not found or not path.startswith(found[-1]):
            found.append(path)
    return found


def _is_within(key: str, roots: Sequence[str]) -> bool:
    """Return whether one of the paths of `_roots` is a key or leads to it: none stands between it and the key."""
    place = bisect_right(roots, f"{key}.")
    return place > 0 and f"{key}.".startswith(roots[place - 1])


def _kind(name: str, kind: str, key: str) -> Kind:
    """Return what a change of one property of an object is an edit of."""
    own: dict[str, Kind] = {
        "ObjectToGround": "ground",
        "ArticadMaterial": "material",
        "Group": "group",
        "Label2": "note",
        "ShapeMaterial": "note",
        "ArticadDensity": "note",
        "ArticadMass": "note",
    }
    if key in own:
        return own[key]
    if kind == "App::VarSet":
        return "parameter" if name == "Parameters" else "dimension"
    if kind == "App::FeaturePython":
        return "limit" if _LIMIT.fullmatch(key) else "joint"
    if kind == "PartDesign::CoordinateSystem":
        return "connector"
    return "moved" if kind in ("App::Part", "App::Link") and key.startswith("Placement.") else "feature"


def _same(old: Any, new: Any) -> bool:
    if isinstance(old, list) and isinstance(new, list):
        return len(old) == len(new) and all(_same(a, b) for a, b in zip(old, new, strict=True))
    numbers = (int, float)
    if isinstance(old, numbers) and isinstance(new, numbers) and not isinstance(old, bool) and not isinstance(new, bool):
        return math.isclose(old, new, rel_tol=SAME, abs_tol=SAME)
    return bool(old == new)


def _said(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, list):
        return f"({', '.join(map(_said, value))})"
    return repr(value) if isinstance(value, str) else str(value)
