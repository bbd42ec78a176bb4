"""The kernels' documentation: what is installed, found by name and by intent; snippets that build."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, get_args

import pytest

from articad.errors import KernelUnavailableError
from articad.kernels import freecad_install
from articad.kernels.build123d import Build123dKernel
from articad.kernels.freecad import FreeCADKernel
from articad.memory.documentation import Dialect, DocumentationStore, Snippet

INTENTS = json.loads(Path(__file__).with_name("intents.json").read_text())
WANTED = 24  # of 30 intents, the right name among the first five


def store(dialect: Dialect) -> DocumentationStore:
    return DocumentationStore(dialect)


def snippets(dialect: Dialect) -> list[Any]:
    return [pytest.param(snippet, id=snippet.title.split(",")[0]) for snippet in DocumentationStore(dialect).snippets]


def found(dialect: Dialect) -> list[str]:
    names = store(dialect)
    return [told["intent"] for told in INTENTS if {entry.name for entry in names.find(told["intent"])} & set(told[dialect])]


def test_the_right_name_is_found_for_most_intents_in_build123d() -> None:
    assert len(INTENTS) == 30
    assert len(found("build123d")) >= WANTED


@pytest.mark.freecad
def test_the_right_name_is_found_for_most_intents_in_freecad() -> None:
    assert len(found("freecad")) >= WANTED


def test_signatures_are_those_of_the_installed_package() -> None:
    fillet, chamfer, box = store("build123d").named(["bd.Fillet", "chamfer", "Box"])
    assert fillet.signature == "fillet(objects: Edge | Vertex | Iterable[Edge | Vertex], radius: float)"
    assert chamfer.signature.startswith("chamfer(")
    assert box.signature.startswith("Box(length: float, width: float, height: float")


def test_a_name_that_does_not_exist_finds_what_it_is_meant_for() -> None:
    assert [entry.name for entry in store("build123d").named(["make_sphere"])] == ["Sphere"]


def test_a_torn_catalogue_is_made_again(tmp_path: Path) -> None:
    first = DocumentationStore("build123d", tmp_path).entries
    (file,) = tmp_path.glob("build123d-*.json")
    file.write_bytes(file.read_bytes()[:500])
    assert DocumentationStore("build123d", tmp_path).entries == first


def test_without_freecad_our_own_helpers_are_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere() -> freecad_install.FreeCAD:
        raise KernelUnavailableError("FreeCAD is not here.")

    monkeypatch.setattr(freecad_install, "find", nowhere)
    helpers = DocumentationStore("freecad", tmp_path)
    assert {"part.pad", "part.pocket", "part.connector"} <= {entry.name for entry in helpers.entries}
    assert helpers.named(["part.pad"])[0].signature.startswith("part.pad(sketch, length, *, both=False")


@pytest.mark.parametrize("dialect", get_args(Dialect))
def test_an_intent_finds_a_worked_example(dialect: Dialect) -> None:
    assert store(dialect).example("screw holes evenly on a circle").title.startswith("A flange")


@pytest.mark.parametrize("snippet", snippets("build123d"))
def test_a_build123d_snippet_builds_and_each_dimension_counts(snippet: Snippet) -> None:
    built(Build123dKernel(), snippet)
    assert {entry.name for entry in store("build123d").entries} >= set(snippet.shows)


@pytest.mark.freecad
@pytest.mark.parametrize("snippet", snippets("freecad"))
def test_a_freecad_snippet_builds_and_each_dimension_counts(snippet: Snippet) -> None:
    built(FreeCADKernel(), snippet)
    assert {entry.name for entry in store("freecad").entries} >= set(snippet.shows)


def built(kernel: Build123dKernel, snippet: Snippet) -> None:
    frame = {"o": [0.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0], "label": "", "joints": []}
    brief = {"name": "part", "description": "", "material": "steel", "envelope_mm": None, "connectors": {"mount": frame}}
    part = kernel.build(snippet.script.encode(), brief | {"dimensions": snippet.dimensions})
    assert part.solid.volume > 100
    assert not part.findings.of("W_DIMENSION_UNUSED"), str(part.findings)
