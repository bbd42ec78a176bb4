"""The checker of the trial finds planted mistakes in files, and none in the three products that are kept with it."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from articad import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.step import write_step
from articad.plan.schema import AssemblyPlan
from benchmarks.trial.check import PARTS, mistakes
from benchmarks.trial.watch import is_made, written

ROOT = Path(__file__).parents[1]
PRODUCTS = ROOT / "benchmarks" / "products"

STEPS = 3


class Files(NamedTuple):
    model: Path
    step: Path


def exported(kind: str, folder: Path) -> Files:
    product = Assembly.from_plan(AssemblyPlan.load(PRODUCTS / kind), PRODUCTS / kind / "parts")
    model, step = (bundle.write(folder / name)[0] for name, bundle in (("mjcf", write_mjcf(product)), ("step", write_step(product))))
    return Files(model, step)


@pytest.fixture(scope="module")
def lamp(tmp_path_factory: pytest.TempPathFactory) -> Files:
    return exported("lamp", tmp_path_factory.mktemp("lamp"))


@pytest.mark.soak
@pytest.mark.parametrize("kind", ["axle", "bed"])
def test_the_products_that_are_kept_have_no_mistake(kind: str, tmp_path: Path) -> None:
    model, step = exported(kind, tmp_path)
    assert mistakes(model, kind, step) == []


@pytest.mark.soak
def test_the_lamp_has_no_mistake(lamp: Files) -> None:
    assert mistakes(lamp.model, "lamp", lamp.step) == []


PLANTED: list[tuple[str, Callable[[str], str], str]] = [
    ("a loop is left open", lambda text: re.sub(r"<weld [^>]*/>", "", text, count=1), r"it has \d freedoms, not 4|closes 1 loops"),
    ("a part is named otherwise", lambda text: text.replace('"bulb"', '"bulbs"'), "there is no body bulb"),
    (
        "a range is narrow",
        lambda text: re.sub(r'(<joint name="tilt"[^>]*range=")-0.78\d* ', r"\g<1>-0.5 ", text),
        r"the range of tilt is \[-28.6, 45.0\]°",
    ),
    (
        "a bar is moved by 2 mm",
        lambda text: re.sub(r'(<body name="bulb" pos=")0 ', r"\g<1>0.04 ", text),
        "bulb differs by|shade and bulb share|bulb and shade share",
    ),
]


@pytest.mark.soak
@pytest.mark.parametrize(("what", "plant", "words"), PLANTED, ids=[what for what, *_ in PLANTED])
def test_planted_mistakes_are_found(lamp: Files, what: str, plant: Callable[[str], str], words: str) -> None:
    text = lamp.model.read_text()
    changed = plant(text)
    assert changed != text, what
    file = lamp.model.with_name("changed.xml")
    file.write_text(changed)
    found = mistakes(file, "lamp", lamp.step, STEPS)
    assert any(re.search(words, line) for line in found), found


def test_the_parts_of_the_tasks_are_those_that_the_checker_wants() -> None:
    for kind, parts in PARTS.items():
        task = (ROOT / "benchmarks" / "trial" / f"{kind}.md").read_text()
        assert f"{len(parts)} parts" in task
        missing = [
            part for part in parts if f"`{part}`" not in task and f"`{part[:-2]}_l` (`_r`)" not in task and f"`{part[:-1]}l`" not in task
        ]
        assert not missing


def test_characters_are_counted_that_are_new() -> None:
    assert written("", "abc\n") == 4
    assert written("abc\ndef\n", "abc\ndeXf\n") == 1
    assert written("abc\ndef\n", "def\n") == 0


@pytest.mark.parametrize(
    ("file", "made"),
    [
        ("plan.json", False),
        ("parts/lid.py", False),
        ("export/a.json", True),
        ("run_2/a.json", True),
        ("__pycache__/a.py", True),
        ("first/parts/lid/part.json", True),
    ],
)
def test_what_a_tool_makes_is_not_written_by_hand(file: str, made: bool, tmp_path: Path) -> None:
    (tmp_path / "first").mkdir()
    (tmp_path / "first" / "request.json").touch()
    (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / file).touch()
    assert is_made(tmp_path / file, tmp_path) == made
