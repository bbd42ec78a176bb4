"""The work to read a FreeCAD document grows as its objects do, counted in bytecodes, never in seconds.

Names compare themselves by bytecodes, too, so that searches in lists are counted.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.assembly import Assembly
from articad.errors import ReadError
from articad.export.freecad import write_freecad_alone
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import box
from articad.importers import freecad
from articad.importers.freecad import read_freecad
from articad.importers.freecad_document import FreeCADDocument
from articad.importers.freecad_edits import Edit, _is_within, _roots, edits
from tests.chains import chain
from tests.growth import MOST_A_PAIR, Watched, bytecodes_a_pair
from tests.hostile_files import archive

STEP, FEW = 12, 4  # FEW of what costs much each

Objects = dict[str, tuple[str, str]]
"""Type and properties by name."""


def text(key: str, value: str) -> str:
    return f'<Property name="{key}" type="App::PropertyString"><String value="{value}"/></Property>'


def number(key: str, value: float) -> str:
    return f'<Property name="{key}" type="App::PropertyFloat"><Float value="{value}"/></Property>'


def links(key: str, names: Iterable[str]) -> str:
    return f'<Property name="{key}" type="App::PropertyLinkList"><LinkList>{"".join(f"<Link value={name!r}/>" for name in names)}</LinkList></Property>'


def placed(key: str, x: float = 0.0, z: float = 0.0) -> str:
    frame = f'<PropertyPlacement Px="{x}" Py="0" Pz="{z}" Q0="0" Q1="0" Q2="0" Q3="1"/>'
    return f'<Property name="{key}" type="App::PropertyPlacement">{frame}</Property>'


def joint(kind: str, parent: str, child: str, more: str = "") -> tuple[str, str]:
    """Return a joint of FreeCAD between the frames of two parts."""
    side = '<Property name="Reference{}"><XLink file="" name="{}"/></Property>'
    word = f'<Property name="JointType"><Integer value="0"/><Enum value="{kind}"/></Property>'
    return "App::FeaturePython", word + side.format(1, parent) + side.format(2, child) + more


def loose(count: int) -> Objects:
    return {f"p{place}": ("App::Part", text("Label", "same")) for place in range(count)}


def grounded(count: int) -> Objects:
    return loose(count) | {f"g{place}": ("App::FeaturePython", links("ObjectToGround", [f"p{place}"])) for place in range(count)}


def apart(count: int) -> Objects:
    """A chain of parts, beside as many loose ones."""
    return loose(2 * count) | {f"j{place}": joint("Slider", f"p{place}", f"p{place + 1}") for place in range(count)}


def islands(count: int) -> Objects:
    """Chains of three parts that nothing connects to the ground."""
    return loose(3 * count) | {f"j{place}": joint("Fixed", f"p{place}", f"p{place + 1}") for place in range(3 * count) if place % 3 < 2}


def linked(count: int) -> Objects:
    """Links to one part, whose solids are more the more links there are."""
    shown = links("LinkedObject", ["p0"])
    return shapes(count) | {f"l{place}": ("App::Link", text("Label", "same") + shown) for place in range(count)}


def shapes(count: int) -> Objects:
    """One part of many shapes, each made of the one before."""
    made = {f"s{place}": ("Part::Feature", links("Base", [f"s{place - 1}"] if place % 2 else [])) for place in range(count)}
    return {"p0": ("App::Part", links("Group", made))} | made


def star(count: int) -> Objects:
    """Parts that turn about parallel axes on one, in pairs of gears."""
    parts = {f"p{place}": ("App::Part", text("Label", "same") + placed("Placement", x=10.0 * place)) for place in range(2 * count)}
    hinges = {
        f"j{place}": joint("Revolute", "p0", f"p{place}", placed("Placement1", x=10.0 * place) + text("Label", "hinge"))
        for place in range(1, 2 * count)
    }
    radii = text("Label", "gears") + number("Distance", 4.0) + number("Distance2", 6.0)
    gears = {f"c{place}": joint("Gears", f"p{place}", f"p{place + 1}", radii) for place in range(1, 2 * count - 1, 2)}
    return parts | hinges | gears


def restricted(count: int) -> Objects:
    """Parts on a chain of cylindrical joints, each with a distance that leaves a turn."""
    chain = {f"j{place}": joint("Cylindrical", f"p{place}", f"p{place + 1}", text("Label", "turn")) for place in range(count)}
    return loose(count + 1) | chain | {f"d{place}": joint("Distance", f"p{place}", f"p{place + 1}") for place in range(count)}


def nested(count: int) -> Objects:
    """References to links whose target is an assembly of many parts."""
    inner = {"p0": ("App::Part", ""), "s": ("Assembly::AssemblyLink", links("Group", [f"i{place}" for place in range(count)]))}
    inner |= {f"i{place}": ("App::Part", "") for place in range(count)}
    return inner | {f"j{place}": joint("Fixed", "p0", "s") for place in range(count)}


def folders(count: int) -> Objects:
    """Parts with a folder each."""
    made = {f"p{place}": ("App::Part", links("Group", [f"f{place}"])) for place in range(count)}
    return made | {f"f{place}": ("App::DocumentObjectGroup", links("Group", [f"s{place}"])) for place in range(count)}


KINDS: dict[str, Callable[[int], Objects]] = {
    made.__name__: made for made in (loose, grounded, apart, islands, linked, nested, folders, shapes, star, restricted)
}


def written(path: Path, objects: Objects) -> Path:
    """Write a document whose assembly shows all objects but the shapes of a part, with a colour of each."""
    held = [name for name, (kind, _) in objects.items() if kind not in ("Part::Feature", "App::DocumentObjectGroup") and name[0] != "i"]
    ground = links("ObjectToGround", ["p0"])
    objects = {"A": ("Assembly::AssemblyObject", links("Group", [*held, "G"])), "G": ("App::FeaturePython", ground)} | objects
    rows = "".join(f'<Object name="{name}" type="{kind}"/>' for name, (kind, _) in objects.items())
    data = "".join(f'<Object name="{name}"><Properties>{inside}</Properties></Object>' for name, (_, inside) in objects.items())
    color = '<Properties><Property name="ShapeColor"><PropertyColor value="4278190335"/></Property></Properties>'
    shown = "".join(f'<ViewProvider name="{name}">{color}</ViewProvider>' for name in objects)
    path.write_bytes(
        archive(
            Document_xml=f"<Document><Objects>{rows}</Objects><ObjectData>{data}</ObjectData></Document>".encode(),
            GuiDocument_xml=f"<Document><ViewProviderData>{shown}</ViewProviderData></Document>".encode(),
        )
    )
    return path


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have comparisons of the names of objects, parts and joints counted."""
    free, listed = freecad._free, FreeCADDocument.links
    monkeypatch.setattr(freecad, "_free", lambda *given: Watched(free(*given)))
    monkeypatch.setattr(FreeCADDocument, "links", lambda *given: list(map(Watched, listed(*given))))


@pytest.mark.usefixtures("watched")
@pytest.mark.parametrize("kind", KINDS)
def test_a_document_is_read_in_linear_work(kind: str, tmp_path: Path) -> None:
    def reading(size: int) -> Callable[[], Any]:
        path = written(tmp_path / f"{size}.FCStd", KINDS[kind](size))
        return lambda: read_freecad(path)

    assert bytecodes_a_pair(reading, FEW if kind == "restricted" else STEP) < MOST_A_PAIR


BOUNDED = {
    "articad.importers.freecad.MAX_CONNECTORS": (
        {"p0": ("App::Part", links("Group", ["c", "d"]))}
        | {name: ("PartDesign::CoordinateSystem", text("ArticadConnector", name)) for name in ("c", "d")}
        | {f"l{place}": ("App::Link", links("LinkedObject", ["p0"])) for place in range(50)},
        "more than 80 connectors",
    ),
    "articad.importers.freecad_document.MAX_LISTED": (
        {f"p{place}": ("App::Part", links("Group", ["f"])) for place in range(10)}
        | {"f": ("App::DocumentObjectGroup", links("Group", ["s"] * 9)), "s": ("App::Part", "")},
        "more than 80 members",
    ),
    "articad.importers.freecad_document.MAX_WALKED": (
        {f"p{place}": ("App::Part", links("Group", ["i"])) for place in range(10)}
        | {f"i{place}": ("App::Part", "") for place in range(9)}
        | {"i": ("App::Part", links("Group", [f"i{place}" for place in range(9)]))},
        "more than 80 groups and shapes",
    ),
}


@pytest.mark.parametrize("bound", BOUNDED)
def test_what_copies_and_shared_folders_show_is_counted(bound: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    objects, reason = BOUNDED[bound]
    path = written(tmp_path / "a.FCStd", objects)
    assert read_freecad(path).parts
    monkeypatch.setattr(bound, 80)
    with pytest.raises(ReadError, match=reason):
        read_freecad(path)


def relabelled(count: int) -> bytes:
    """Return a chain that articad wrote, in which each object has another label, and no part has its shape."""
    (content,) = write_freecad_alone(chain(count)).files.values()
    with zipfile.ZipFile(io.BytesIO(content)) as entries:
        text = re.sub(r'file="[^"]+"', 'file=""', entries.read("Document.xml").decode())
    return archive(Document_xml=re.sub(r'(name="Label".*?<String value="[^"]*)', r"\1 again", text, flags=re.DOTALL).encode())


def reshaped(count: int) -> bytes:
    """Return a chain that articad wrote, in which each part has another shape, and each joint another limit."""
    made = chain(count)
    drawn = replace(made, parts={name: replace(part, solid=None) for name, part in made.parts.items()})
    (content,) = write_freecad_alone(drawn).files.values()
    block = Part.from_solid("block", Solid.from_mesh(box(7.0, 6.0, 5.0), deflection=0.01))
    (other,) = write_freecad_alone(Assembly.from_parts("block", parts=[block], joints=[], ground="block")).files.values()
    with zipfile.ZipFile(io.BytesIO(content)) as entries:
        text = entries.read("Document.xml").decode()
    assert text.count("-1.1459") == count - 1
    with zipfile.ZipFile(io.BytesIO(other)) as entries:
        shapes = {f"link{number}_body.bms": entries.read("block_body.bms") for number in range(count)}
    return archive(Document_xml=text.replace("-1.1459", "-1.2459").encode(), **shapes)


@pytest.mark.usefixtures("watched")
@pytest.mark.parametrize("made", [relabelled, reshaped])
def test_edits_of_what_articad_wrote_are_found_in_linear_work(made: Callable[[int], bytes], tmp_path: Path) -> None:
    said = {"relabelled": "is now labelled", "reshaped": "is not the one that articad wrote"}[made.__name__]

    def reading(size: int) -> Callable[[], Any]:
        path = tmp_path / f"{size}.FCStd"
        path.write_bytes(made(size))
        assert len([finding for finding in read_freecad(path).findings if said in finding.message]) >= size
        return lambda: read_freecad(path)

    assert bytecodes_a_pair(reading, FEW) < MOST_A_PAIR


def test_values_that_follow_expressions_are_told_from_others_in_linear_work() -> None:
    def content(count: int, value: float) -> dict[str, Any]:
        places = range(count)
        expressions = {f"Constraints.a{place}": "1" for place in places}
        values = {f"Constraints.{letter}{place}.between": value for place in places for letter in "ab"}
        return {"s": {"type": "Sketcher::SketchObject", "label": "s", "expressions": expressions, "values": values}}

    def comparing(size: int) -> Callable[[], Any]:
        before, now = content(size, 1.0), content(size, 2.0)
        assert {edit.key for edit in edits(before, now)} == {f"Constraints.b{place}.between" for place in range(size)}
        return lambda: edits(before, now)

    assert bytecodes_a_pair(comparing, STEP) < MOST_A_PAIR


def test_members_that_left_a_group_are_named_in_linear_work() -> None:
    def naming(size: int) -> Callable[[], Any]:
        names = [Watched(f"p{place}") for place in range(size)]
        edit = Edit("group", "A", "A", "App::Part", "Group", names, names[::-2])
        assert str(edit).count(",") == size // 2
        return edit.__str__

    assert bytecodes_a_pair(naming, STEP) < MOST_A_PAIR


PATHS = st.lists(st.sampled_from(["a", "b", "aa", "a.b", "a.b.c", "a-b", "b.a", "a.c"]), max_size=6)


@given(PATHS, st.sampled_from(["a", "a.b", "a.bb", "a.b.c", "a.c.d", "ab", "aa.b", "b", "a-b", "a-b.c", "b.b", "c"]))
def test_a_key_is_within_a_path_if_it_begins_with_it(paths: list[str], key: str) -> None:
    assert _is_within(key, _roots(paths)) == any(key == path or key.startswith(f"{path}.") for path in paths)
