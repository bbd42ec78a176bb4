"""Documents of FreeCAD whose records by articad somebody forged: an error of ours, or the document as it is, in `convert` and in `pull`."""

from __future__ import annotations

import contextlib
import io
import json
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.errors import ArticadError
from articad.export.freecad import write_freecad_alone
from articad.export.freecad_content import PROPERTY, packed_content, unpacked_content
from articad.formats import NAMED
from articad.importers.freecad import read_freecad
from articad.plan.schema import AssemblyPlan
from articad.runs.pull import pull
from tests.chains import chain

NESTED = json.loads("[" * 900 + "]" * 900)
ODD: dict[str, Any] = {
    "an endless number": 10**400, "nothing": None, "lists": NESTED, "lists of lists": [[1]], "an object": {}, "no number": "x", "zero": 0,
}  # fmt: skip
PLACES: dict[str, tuple[str, ...]] = {
    "volume": ("solid", "volume"), "drawn volume": ("drawn", "volume"), "centre": ("solid", "com"), "moments": ("solid", "inertia"),
    "name": ("name",), "colour": ("color",), "shapes": ("visuals",), "mass": ("mass",), "frame": ("frame",),
}  # fmt: skip


@cache
def written() -> tuple[AssemblyPlan, dict[str, bytes]]:
    """Return the plan of a chain, and the files in its FreeCAD document."""
    assembly = chain(3)
    files = NAMED["plan"].writer(assembly).files
    plan = AssemblyPlan.from_json(json.loads(next(content for name, content in files.items() if name.endswith("plan.json"))))
    bundle = write_freecad_alone(assembly)
    with zipfile.ZipFile(io.BytesIO(bundle.files[bundle.main])) as archive:
        return plan, {name: archive.read(name) for name in archive.namelist()}


def is_answered(path: Path, change: Callable[[Any], None]) -> None:
    """Change a document's XML, and read it."""
    plan, files = written()
    root = etree.fromstring(files["Document.xml"])
    change(root)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, etree.tostring(root) if name == "Document.xml" else content)
    for work in (lambda: read_freecad(path), lambda: "".join(map(str, pull(plan, path).findings))):
        with contextlib.suppress(ArticadError):
            work()


def held(root: Any, name: str) -> Any:
    return next(row.find("String") for row in root.iter("Property") if row.get("name") == name)


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("odd", ODD)
def test_a_forged_record_of_a_part_is_refused_or_ignored(odd: str, place: str, tmp_path: Path) -> None:
    def forge(root: Any) -> None:
        lines = held(root, "ArticadRecords")
        records = [json.loads(line) for line in lines.get("value").split("\n")]
        record = next(record for record in records if record["kind"] == "part")
        for key in PLACES[place][:-1]:
            record = record.setdefault(key, {})
        record[PLACES[place][-1]] = ODD[odd]
        lines.set("value", "\n".join(map(json.dumps, records)))

    is_answered(tmp_path / "it.FCStd", forge)


@pytest.mark.parametrize("key", ["values", "members", "expressions", "label"])
@pytest.mark.parametrize("odd", ODD)
def test_forged_content_is_refused_or_ignored(odd: str, key: str, tmp_path: Path) -> None:
    def forge(root: Any) -> None:
        packed = held(root, PROPERTY)
        content = unpacked_content(packed.get("value"))
        assert content is not None
        for item in content.values():
            if key == "members":
                item["values"]["Group"] = ODD[odd]
            elif key == "label":
                item["label"] = ODD[odd]
            else:
                item[key] = dict.fromkeys([*item[key], "Placement.x"], ODD[odd])
        packed.set("value", packed_content(content))

    is_answered(tmp_path / "it.FCStd", forge)


def test_a_limit_without_its_number_is_no_limit(tmp_path: Path) -> None:
    def forge(root: Any) -> None:
        for row in [row for row in root.iter("Property") if row.get("name") in ("AngleMin", "LengthMin", "EnableAngleMax")]:
            row.getparent().remove(row)
        for row in root.iter("Property"):
            if row.get("name", "").startswith("Enable"):
                row.find("Bool").set("value", "true")

    is_answered(tmp_path / "it.FCStd", forge)
