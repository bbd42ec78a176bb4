"""Characters that no XML file holds or that terminals obey: no text of a plan, a record or a STEP file brings them in."""

from __future__ import annotations

import copy
import csv
import io
import json
import zipfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

import articad
from articad.assembly import Assembly
from articad.cli import main
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import PlanError, ReadError
from articad.formats import NAMED
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.importers.records import read_records
from articad.kernels.step_assembly import _part
from articad.kinematics import declare
from articad.papers.bill import written_csv
from articad.plan.schema import AssemblyPlan
from articad.texts import spoiled

STARTER = json.loads((Path(articad.__file__).parent / "starter" / "plan.json").read_text())
FOUR_BAR = json.loads((Path(__file__).parent / "fuzz" / "corpus" / "plan" / "four_bar.json").read_text())
BAD = ("\x00", "\x08", "\x1b", "\x7f", "\x9b", "\ud800", "\udfff", "\ufffe", "\uffff")
GOOD = "tabs\tand\nlines, naïve ☃ 🙂 שלום \u200f\u2028"


def texts(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the holder and the key of every text in a document, its keys' own values included."""
    for key in list(value) if isinstance(value, dict) else range(len(value)):
        if isinstance(value[key], str):
            yield value, key
        elif isinstance(value[key], dict | list):
            yield from texts(value[key])


@pytest.mark.parametrize("document", [STARTER, FOUR_BAR], ids=["starter", "four_bar"])
def test_no_text_of_a_plan_holds_what_no_file_holds(document: Any) -> None:
    """Each text of the plan in turn, with each character in turn; a text is refused at its own place."""
    places = list(texts(copy.deepcopy(document)))
    assert len(places) > 40
    for number in range(len(places)):
        changed = copy.deepcopy(document)
        holder, key = list(texts(changed))[number]
        holder[key] += BAD[number % len(BAD)]
        with pytest.raises(PlanError) as raised:
            AssemblyPlan.loads(json.dumps(changed))
        assert spoiled(str(raised.value)) is None


def test_other_scripts_and_lines_are_texts() -> None:
    document = copy.deepcopy(STARTER) | {"description": GOOD}
    assert AssemblyPlan.loads(json.dumps(document)).description == GOOD


@pytest.mark.parametrize("character", BAD)
def test_no_record_holds_what_no_file_holds(character: str, tmp_path: Path) -> None:
    """Records are JSON inside XML: their escapes bring in what XML refuses."""
    for record in (
        {"kind": "part", "name": f"a{character}"},
        {"kind": "part", f"a{character}": 1},
        {"kind": "part", "x": [{"y": [character]}]},
    ):
        with pytest.raises(ReadError, match="A record holds"):
            read_records([json.dumps(record)], tmp_path / "a.urdf")


def test_names_of_a_step_file_have_escapes_in_their_place() -> None:
    """STEP spells any character; what the confined worker says of one ends up in names."""
    mesh = box(1.0, 1.0, 1.0)
    whole = TriMesh(mesh.vertices, mesh.triangles, np.zeros(len(mesh.triangles), dtype=np.int32))
    part = _part(0, {"product": "a\x1b[2J", "instance": "b\ud800", "path": ["c\x00"], "valid": True}, whole, Counter())
    assert (part.product, part.name, part.where) == ("a\\u001b[2J", "b\\ud800", "c\\u0000/b\\ud800")


def cell_of(text: str) -> str:
    """Return what a reader of CSV finds in the cell of a text."""
    (cell,) = next(csv.reader(io.StringIO(written_csv(("name",), [(text,)]).decode().partition("\r\n")[2], newline="")))
    return cell


HIDDEN = [
    *"\t\r\n \u00a0\u3000\u2028\x00\x1b\x7f\x85\xad\u200b\u200d\u200e\u200f\u202a\u202e\u2060\u2066\u2069\ufeff\u034f\u061c\u115f\u180e\u2800\u3164\ufe0f\uffa0",
    "\U000e0041", "\ufeff\u200b ", '"', "\u200e\t",
]  # fmt: skip


@pytest.mark.parametrize("before", ["", *HIDDEN], ids=ascii)
@pytest.mark.parametrize("sign", "=+-@\uff1d\uff0b\uff0d\uff20\ufe66\ufe62\ufe63\ufe6b\u207c\u2212", ids=ascii)
def test_no_cell_of_a_parts_list_is_a_formula(before: str, sign: str) -> None:
    """Programs for tables pass over what is not seen, and take the other widths of a sign for it."""
    again = "'" if before[-1:] in {"\t", "\r", "\n"} and before else ""  # a tab and the end of a line may separate cells
    assert cell_of(f"{before}{sign}1+1") == f"'{before}{again}{sign}1+1"


@pytest.mark.parametrize("separator", [";", "\t", "\n", "\r", '";', ';"', "; ", ";\u200b", ";\t", "\t;", "\r\n", "\t "], ids=ascii)
def test_no_cell_is_a_formula_where_a_country_separates_cells_otherwise(separator: str) -> None:
    """Cut the line where a program would, without quotation marks, as a separator of its own inside a word is cut."""
    line = written_csv(("name",), [(1, f"a{separator}=1+1")]).decode().partition("\r\n")[2]
    cells = line.replace('"', "").replace("\t", ";").replace("\r", ";").replace("\n", ";").split(";")
    assert len(cells) > 1
    assert not any(cell.strip(" \u200b").startswith("=") for cell in cells)


@pytest.mark.parametrize("text", ["arm", "a-b", "a = b", "5 mm + 3 mm", "a, -5", "\u200fשלום", "x@y", "a; b", "'=1"], ids=ascii)
def test_ordinary_texts_of_a_table_stay(text: str) -> None:
    assert cell_of(text) == text


def test_a_long_text_is_looked_through_once() -> None:
    """A text of a foreign file has up to 65,536 characters; looking from each of them to the end would take minutes."""
    for text in ("\t" * 65_536, " ;" * 32_768, "\t\u200b" * 32_768):
        (_, row) = csv.reader(io.StringIO(written_csv(("name",), [(f"a{text}a",)]).decode()))
        assert row[0].endswith(f"a{text}a")


@pytest.mark.parametrize(
    "line", [["generate", "a \udcff box"], ["edit", "run", "\udcff"], ["memory", "search", "\udcff"]], ids=["generate", "edit", "memory"]
)
def test_a_request_that_is_no_text_is_refused(line: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    """Bytes that are not UTF-8 come as halves of surrogate pairs, which no record holds."""
    with pytest.raises(SystemExit) as ended:
        main(line)
    assert ended.value.code == 2
    assert "the text is not UTF-8" in capsys.readouterr().err


HOSTILE = "x\x1b]0;own\x07<script>alert(1)</script>\u202e\n=1+1]]>&#x0;\"'../../y\x00\ufffe"
WRITTEN = sorted(set(NAMED) - {"freecad", "step"})  # those two need a kernel


@pytest.mark.parametrize("name", WRITTEN)
def test_every_format_holds_hostile_names_and_stays_what_it_is(name: str) -> None:
    """Names of the caller's own assembly, which no reader has looked at."""
    frame = SE3.identity()
    one, other = (
        Part.from_mesh(each, box(10, 10, 10), density=700, connectors={"c": Connector("c", frame)}, material=HOSTILE)
        for each in (HOSTILE, f"{HOSTILE}2")
    )
    joint = declare.revolute(HOSTILE, one["c"], other["c"], limits=(0.0, 1.0))
    assembly = Assembly.from_parts(HOSTILE, parts=[one, other], joints=[joint], ground=HOSTILE)
    files = NAMED[name].write(assembly).files
    assert files
    for file, content in files.items():
        assert ".." not in Path(file).parts
        assert file.isprintable()
        if Path(file).suffix == ".3mf":
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                content = archive.read("3D/3dmodel.model")  # noqa: PLW2901
        if Path(file).suffix in {".urdf", ".xml", ".sdf", ".3mf"}:
            etree.fromstring(content)
        if Path(file).suffix not in {".stl", ".glb"}:
            assert not set("\x1b\x07\x00") & set(content.decode())
