"""The stored findings on the references: the page is current, the meshes decide what is told of them, and results of earlier programs are judged again."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from build123d import Cylinder, Pos

from articad.connectors import SE3
from articad.interference.scene import Scene
from tests.interference.mechanisms import joint
from tests.realisation.test_holders import stack
from tests.realisation.test_verdicts import mesh

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "realised.py"
POSES = dict.fromkeys("abc", SE3.identity())


@pytest.fixture(scope="module")
def realised() -> ModuleType:
    spec = importlib.util.spec_from_file_location("realised_script", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def stored(realised: ModuleType) -> dict[str, Any]:
    return dict(realised.stored_results())


def scene() -> Scene:
    """A pin with a head below, an eye on it 2 mm above the head, and a cap 3 mm above the eye."""
    shapes = {"a": Cylinder(3, 40) + Pos(0, 0, -14) * Cylinder(8, 8), "b": Pos(0, 0, -3) * (Cylinder(8, 10) - Cylinder(3.1, 10)), "c": Pos(0, 0, 7) * (Cylinder(8, 4) - Cylinder(3.1, 4))}  # fmt: skip
    return Scene.of({name: mesh(shape) for name, shape in shapes.items()}, [joint("j", "revolute", "a", "b")], deflection=0.01)


def test_the_page_is_that_of_the_stored_results(realised: ModuleType) -> None:
    assert realised.PAGE.read_text(encoding="utf-8") == realised.stored_page()


def test_findings_that_the_meshes_do_not_settle_are_argued_and_no_others(realised: ModuleType, stored: dict[str, Any]) -> None:
    unsettled = {
        (name, one["where"])
        for name, row in stored["rows"].items()
        for one in row["findings"]
        if realised.verdict(one) in ("stopped", "not tried")
    }
    assert set(realised.ARGUED) == unsettled


def test_a_finding_in_question_without_an_argument_is_told_as_such(realised: ModuleType) -> None:
    tried = [{"way": "+z", "mm": 2.0, "free": False, "stop": "a", "pushed": []}]
    finding = {"code": "W_JOINT_PARTLY_MADE", "where": "joints.j", "parts": ["a", "b"], "message": "", "tried": tried}
    row = {"product": "", "programs": "now", "joints": {}, "findings": [finding], "seconds": 0.0}
    assert "- `one`, `joints.j`: Not argued yet." in realised.page({"programs": "now", "planned": ["one"], "rows": {"one": row}})


def test_every_stored_motion_agrees_with_its_distance(realised: ModuleType, stored: dict[str, Any]) -> None:
    for name, row in stored["rows"].items():
        for finding in row["findings"]:
            for one in finding["tried"]:
                far = one.get("mm", one.get("rad"))
                end = realised.FREE_MM if "mm" in one else realised.FREE_RAD
                assert far is None or (far >= end - 1e-3) == one["free"] == (one["stop"] is None), name


def test_a_part_moves_until_it_enters_another(realised: ModuleType) -> None:
    up, down = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
    assert realised.travel(scene(), POSES, ["b"], ["a"], up) == (realised.FREE_MM, None)
    far, stop = realised.travel(scene(), POSES, ["b"], ["a", "c"], up)
    assert stop == "c"
    assert far == pytest.approx(3.0, abs=realised.STEP_MM)
    far, stop = realised.travel(scene(), POSES, ["b"], ["a"], down)
    assert stop == "a"
    assert far == pytest.approx(2.0, abs=realised.STEP_MM)


@pytest.mark.parametrize("gaps", [(0.6, 0.4), (0.3, 1.2, 0.8), (2.0, 2.0, 2.0)])
def test_parts_are_pushed_along_from_where_they_are_entered(realised: ModuleType, gaps: tuple[float, ...]) -> None:
    """The travel is the sum of the gaps, less than a step for each; 6 mm are beyond what is tried."""
    meshes = {name: mesh(shape) for name, shape in stack(gaps).items()}
    scene, poses = Scene.of(meshes, [joint("j", "revolute", "a", "b")], deflection=0.01), dict.fromkeys(meshes, SE3.identity())
    washers = [name for name in meshes if name.startswith("w")]
    far, stop, pushed = realised.pushing(scene, poses, ["b"], ["a"], washers, np.array([0.0, 0.0, 1.0]))
    assert pushed == washers
    if sum(gaps) > realised.FREE_MM:
        assert (far, stop) == (realised.FREE_MM, None)
    else:
        assert stop == "a"
        assert sum(gaps) - realised.STEP_MM * len(gaps) <= far <= sum(gaps) + realised.DEEP_MM * len(gaps) + 0.05


def test_an_eye_tilts_on_its_pin_by_its_play_only(realised: ModuleType) -> None:
    """A bore of 10 mm with a play of 0.1 mm lets a pin tilt by about 2 · 0.1 / 10 = 0.02 rad."""
    far, stop = realised.tilt(scene(), POSES, ["b"], ["a"], SE3.identity(), 0)
    assert stop == "a"
    assert far <= realised.STEP_RAD + 1e-9
    far, stop = realised.tilt(scene(), POSES, ["b"], ["a"], SE3.identity(), 2)
    assert (far, stop) == (pytest.approx(realised.FREE_RAD), None)


@pytest.mark.parametrize(
    ("tried", "verdict"),
    [
        ([], "not tried"),
        ([{"free": True}, {"free": True}], "confirmed"),
        ([{"free": True}, {"free": False, "alone": True}], "held by others"),
        ([{"free": True}, {"free": False, "alone": False}], "stopped"),
        ([{"free": False, "mm": 2.0, "room": 2.1}], "confirmed"),
        ([{"free": False, "mm": 2.0, "room": 3.0}], "stopped"),
        ([{"free": True, "mm": 5.0, "room": 3.0}], "stopped"),
        ([{"free": True, "mm": 5.0, "room": 9.0}], "confirmed"),
        ([{"free": False, "mm": 2.0, "room": 9.0}], "stopped"),
        ([{"free": True, "rad": 0.15, "room": 0.2}], "confirmed"),
        ([{"free": False, "mm": 1.75, "alone": True, "alone_mm": 5.0, "held": 2.1, "held_by": ["c", "a"]}], "confirmed"),
        ([{"free": False, "mm": 1.0, "alone": True, "alone_mm": 5.0, "held": 2.1, "held_by": ["c", "a"]}], "held by others"),
        ([{"free": True, "mm": 5.0, "alone": True, "alone_mm": 5.0, "held": 2.1, "held_by": ["c", "a"]}], "held by others"),
        ([{"free": False, "mm": 1.75, "alone": False, "alone_mm": 3.0, "held": 2.1, "room": 3.1, "held_by": ["c", "a"]}], "confirmed"),
        ([{"free": False, "mm": 1.75, "alone": False, "alone_mm": 3.0, "held": 2.1, "room": 4.0, "held_by": ["c", "a"]}], "stopped"),
    ],
)
def test_a_finding_is_confirmed_if_the_meshes_stop_nothing_of_it(realised: ModuleType, tried: list[dict[str, Any]], verdict: str) -> None:
    assert realised.verdict({"tried": tried}) == verdict


def test_results_of_earlier_programs_are_due(realised: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text("{}")
    row = {"product": realised.digest(tmp_path), "programs": realised.programs()}
    found = {"one": tmp_path}
    assert list(realised.due({"rows": {"one": row}}, found, [])) == []
    assert list(realised.due({"rows": {"one": row | {"programs": "before"}}}, found, [])) == ["one"]
    (tmp_path / "plan.json").write_text('{"name": "one"}')
    assert list(realised.due({"rows": {"one": row}}, found, [])) == ["one"]
