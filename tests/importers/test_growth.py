"""The work to read a FreeCAD document grows as its objects do, counted in bytecodes, never in seconds.

Counts at three sizes n, 2n, 3n of work that is linear have no second difference; that of work c·n² is 2·c·n². Names compare themselves by
bytecodes, too, so that a search in a list, which is one bytecode otherwise, counts each of its comparisons.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest

from articad.importers import freecad
from articad.importers.freecad import read_freecad
from articad.importers.freecad_document import FreeCADDocument
from tests.hostile_files import archive

STEP, FEW = 12, 4  # FEW of what costs much each
MOST_A_PAIR = 0.25  # bytecodes for each pair of objects: one comparison of two names is more than ten

Objects = dict[str, tuple[str, str]]
"""Type and properties by name."""


class Watched(str):
    """A name whose comparisons are counted."""

    __hash__ = str.__hash__
    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        return str.__eq__(self, other)


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
    """Links to one part that has no shape."""
    shown = links("LinkedObject", ["p0"])
    return loose(1) | {f"l{place}": ("App::Link", text("Label", "same") + shown) for place in range(count)}


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


KINDS: dict[str, Callable[[int], Objects]] = {
    made.__name__: made for made in (loose, grounded, apart, islands, linked, shapes, star, restricted)
}


def written(path: Path, objects: Objects) -> Path:
    """Write a document whose assembly shows all objects but the shapes of a part, with a colour of each."""
    held = [name for name, (kind, _) in objects.items() if kind != "Part::Feature"]
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


def bytecodes_of(work: Callable[[], Any]) -> int:
    """Return how many bytecodes of Python a piece of work runs."""
    count = 0

    def seen(frame: Any, event: str, _argument: object) -> Any:
        nonlocal count
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        count += event == "opcode"
        return seen

    sys.settrace(seen)
    try:
        work()
    finally:
        sys.settrace(None)
    return count


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have comparisons of the names of objects, parts and joints counted."""
    free, listed = freecad._free, FreeCADDocument.links
    monkeypatch.setattr(freecad, "_free", lambda *given: Watched(free(*given)))
    monkeypatch.setattr(FreeCADDocument, "links", lambda *given: list(map(Watched, listed(*given))))


@pytest.mark.usefixtures("watched")
@pytest.mark.parametrize("kind", KINDS)
def test_a_document_is_read_in_linear_work(kind: str, tmp_path: Path) -> None:
    step = FEW if kind == "restricted" else STEP
    files = [written(tmp_path / f"{times}.FCStd", KINDS[kind](times * step)) for times in (1, 2, 3)]
    read_freecad(files[0])  # imports and caches
    one, two, three = (bytecodes_of(lambda file=file: read_freecad(file)) for file in files)  # type: ignore[misc]
    assert (three - 2 * two + one) / (2 * step**2) < MOST_A_PAIR
