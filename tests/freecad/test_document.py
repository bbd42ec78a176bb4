"""FreeCAD documents: what FreeCAD itself, in a new process, finds in the files that we write."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import articad as ac
from articad.connectors.se3 import SE3
from articad.errors import ExportError, KernelUnavailableError, UnrepresentableError
from articad.export import freecad as export
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_file import python_classes
from articad.export.freecad_job import Job
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD
from articad.plan.resolve import resolve
from tests.freecad import cupboard, opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SMALL_MM, SMALL_RAD = 1e-6, 1e-8


@cache
def assembly(name: str) -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(EXAMPLES / name / "plan.json"), EXAMPLES / name / "parts")


@cache
def content(name: str) -> bytes:
    bundle = write_freecad(assembly(name))
    assert bundle.findings.ok
    assert not bundle.findings, bundle.findings
    return bundle.files[bundle.main]


@pytest.mark.parametrize("name", sorted(path.parent.name for path in EXAMPLES.glob("*/plan.json")))
def test_a_new_process_solves_without_moving_a_part_and_mends_disturbances(name: str) -> None:
    look = solved_and_mended(name, None)
    assert look["touched"] == []


@pytest.mark.freecad_next
@pytest.mark.parametrize("name", sorted(path.parent.name for path in EXAMPLES.glob("*/plan.json")))
def test_the_same_file_passes_in_the_next_freecad(name: str) -> None:
    """It comes to be recomputed there, as a file of an earlier FreeCAD; nothing in it may become invalid."""
    look = solved_and_mended(name, opened.newer())
    assert tuple(map(int, look["version"][:2])) >= (1, 1)


def solved_and_mended(name: str, freecad: FreeCAD | None) -> opened.Json:
    """Solve an example's document, disturb each part and solve again; return what was in it at first.

    Where joints close loops, FreeCAD's solver may need some presses of Solve, and may give up; then it leaves all as it is.
    """
    made = assembly(name)
    rng = np.random.default_rng(7)
    moving, presses = [part for part in made.parts if part != made.ground], 5 if made.mechanism.loop_joints else 1
    shakes: list[opened.Json] = [{"do": "perturb", "part": part, "by": opened.shaken(rng), "times": presses} for part in moving]
    look, solved, *mended = opened.steps(content(name), {"do": "look"}, {"do": "solve"}, *shakes, freecad=freecad)
    rest = dict(made.at())
    assert look["invalid"] == []
    assert solved["code"] == 0
    assert opened.small(opened.moved(rest, opened.frames(solved["parts"])), SMALL_MM, SMALL_RAD)
    assert opened.small(opened.worst(made, opened.frames(look["parts"])), 1e-9, 1e-9)
    assert opened.small(opened.worst(made, opened.frames(look["parts"]), look["connectors"]), 1e-9, 1e-9)
    given_up = set()
    for shake, after in zip(shakes, mended, strict=True):
        frames, part = opened.frames(after["parts"]), str(shake["part"])
        if after["code"] != 0 and presses > 1:
            given_up.add(part)
            by = opened.frames({part: shake["by"]})[part]
            disturbed = rest | {part: rest[part] @ by}
            assert opened.small(opened.moved(disturbed, frames), SMALL_MM, SMALL_RAD), part
        else:
            assert after["code"] == 0, part
            assert opened.small(opened.worst(made, frames), SMALL_MM, SMALL_RAD), part
    assert len(given_up) <= len(moving) / 4, given_up
    return look


def test_the_residuals_see_a_part_that_is_out_of_place() -> None:
    made = assembly("metronome")
    rest = dict(made.at())
    rest["pendulum"] = rest["pendulum"] @ ac.SE3.trans(0.0, 0.001, 0.0)
    assert opened.worst(made, rest)[0] > 9e-4


def test_the_same_assembly_gives_the_same_bytes() -> None:
    again = write_freecad(assembly("wardrobe"))
    assert again.files[again.main] == content("wardrobe")


def test_the_solver_is_not_asked_while_a_document_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each placement is given, and the solver's time grows faster than the square of the number of joints. Who verifies asks it."""
    asked, run = {}, FreeCAD.run

    def heard(freecad: FreeCAD, program: Path, **more: Any) -> Any:
        ended = run(freecad, program, **more)
        asked[program.name] = "MbD:" in ended.said
        return ended

    monkeypatch.setattr(FreeCAD, "run", heard)
    write_freecad(assembly("four_bar"))
    assert asked == {"document.py": False, "examine.py": True}


def test_the_file_is_visible_and_names_no_person_time_or_foreign_class() -> None:
    with zipfile.ZipFile(io.BytesIO(content("wardrobe"))) as archive:
        names = archive.namelist()
        assert (names[0], names[-1]) == ("Document.xml", "GuiDocument.xml")  # elsewhere, all shapes are empty in FreeCAD's window
        assert {entry.date_time for entry in archive.infolist()} == {(2000, 1, 1, 0, 0, 0)}
        gui, document = archive.read("GuiDocument.xml").decode(), archive.read("Document.xml").decode()
    joints = len(assembly("wardrobe").joints)
    assert gui.count('class="ViewProviderJoint"') == joints
    assert gui.count('class="ViewProviderGroundedJoint"') == 1
    assert "/work" not in document
    assert python_classes(content("wardrobe")) == {"JointObject.Joint", "JointObject.GroundedJoint"}


def test_parameters_move_connectors_parts_and_limits() -> None:
    before, after = opened.steps(content("wardrobe"), {"do": "look"}, {"do": "set", "values": {"width": 1000.0}})
    assert after["invalid"] == []
    assert after["code"] == 0
    wider = assembly("wardrobe").with_parameters(width=1000.0)
    for part in ("cabinet", "door_left", "drawer_lower"):
        for name, connector in wider.parts[part].connectors.items():
            assert after["connectors"][part][name][:3] == pytest.approx(connector.frame.translation, abs=1e-9)
    assert before["connectors"]["cabinet"] != after["connectors"]["cabinet"]
    mm, rad = opened.worst(wider, opened.frames(after["parts"]), after["connectors"])
    assert mm <= SMALL_MM
    assert rad <= SMALL_RAD


def test_what_freecad_does_not_hold_is_a_loss_and_strict_refuses_it() -> None:
    losses = write_freecad(assembly("geared_four_bar")).losses
    assert any(loss.where.startswith("couplings.") and loss.refused for loss in losses)
    with pytest.raises(UnrepresentableError):
        write_freecad(assembly("geared_four_bar"), strict=True)


def test_a_freecad_that_fails_is_an_error_with_its_last_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text("import sys\nprint('no such thing', flush=True)\nsys.exit(3)\n")
    monkeypatch.setattr(export, "PROGRAM", broken)
    with pytest.raises(ExportError, match="no such thing") as raised:
        write_freecad(assembly("metronome"))
    assert [finding.code for finding in raised.value.findings] == ["E_FREECAD"]


def test_without_freecad_the_remedy_is_one_sentence(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARTICAD_FREECAD", str(tmp_path))
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(KernelUnavailableError, match="articad install freecad") as raised:
        freecad_install.find()
    assert raised.value.looked_in


def test_a_freecad_that_is_named_is_not_replaced_by_another(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARTICAD_FREECAD", str(tmp_path / "mistyped"))
    with pytest.raises(KernelUnavailableError, match="mistyped contains no FreeCAD"):
        freecad_install.find()


@pytest.mark.parametrize("native", [False, True], ids=["freecad", "alone"])
def test_a_parameter_over_a_frozen_shape_is_fixed_and_says_so(native: bool) -> None:
    made = assembly("wardrobe")
    bundle = write_freecad_alone(made) if native else write_freecad(made)
    (look,) = opened.steps(bundle.files[bundle.main], {"do": "look"})
    groups = {name: (group, editable) for name, (group, _, editable) in look["parameters"].items()}
    shown = {
        part: [label for label in look["labels"].values() if label.startswith((f"{part} body", f"{part} dimensions"))]
        for part in made.parts
    }
    assert all(label.endswith(("(frozen)", "(frozen shape)")) for labels in shown.values() for label in labels)
    assert len(shown["door_left"]) == len(shown["door_right"]) == 2  # the mirror image of a frozen shape is frozen
    assert groups["p_width"] == ("Fixed parameters", False)
    assert "Fixed: it shapes" in look["parameters"]["p_width"][1]
    assert groups["p_opening"] == ("Parameters", True)  # it limits a hinge and shapes nothing
    live = sum(editable for _, editable in groups.values())
    assert look["labels"]["Parameters"] == f"Parameters ({live} live, {len(groups) - live} fixed)"


def test_a_parameter_that_follows_only_fixed_ones_is_fixed() -> None:
    bundle = write_freecad_alone(assembly("four_bar"))
    (look,) = opened.steps(bundle.files[bundle.main], {"do": "look"})
    assert look["labels"]["Parameters"] == "Parameters (all fixed)"
    group, why, editable = look["parameters"]["p_front"]
    assert (group, editable) == ("Fixed parameters", False)
    assert "it follows" in why


def test_parameters_over_feature_trees_are_live() -> None:
    bundle = write_freecad(cupboard.assembly())
    (look,) = opened.steps(bundle.files[bundle.main], {"do": "look"})
    assert look["labels"]["Parameters"] == "Parameters"
    assert {group for group, _, _ in look["parameters"].values()} == {"Parameters"}
    labels = {*look["labels"].values()}
    assert not any("frozen" in label for label in labels)
    assert {"door_left dimensions", "door_right dimensions (of door_left)"} <= labels  # those of the image drive nothing


@pytest.mark.parametrize("freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"])
def test_every_parameter_moved_and_moved_back_puts_each_part_where_the_plan_does(freecad: Callable[[], FreeCAD]) -> None:
    plan, bundle = cupboard.plan(), write_freecad(cupboard.assembly())
    values = {row.name: float(row.value) for row in plan.parameters if not isinstance(row.value, str)}
    moves = [{name: share * value} for name, value in values.items() for share in (0.95, 1.05, 1.0)]
    wanted = [(move, {name: part.T_rest for name, part in resolve(plan, **(values | move)).parts.items()}) for move in moves]
    looks = opened.steps(bundle.files[bundle.main], *({"do": "set", "values": move} for move in moves), freecad=freecad())
    for look, (move, rest) in zip(looks, wanted, strict=True):
        assert (look["code"], look["invalid"]) == (0, []), move
        assert opened.small(opened.moved(rest, opened.frames(look["parts"])), 1e-6, 1e-8), move


def test_a_part_that_is_turned_in_freecad_stays_turned_when_nothing_changes() -> None:
    bundle = write_freecad(cupboard.assembly())
    turned = {"do": "turn", "part": "flap", "by": [0.0, 0.0, 0.0, *SE3.rot_x(0.2).quaternion]}
    (look,) = opened.steps(bundle.files[bundle.main], turned)
    rest = cupboard.assembly().at()["flap"]
    D = rest.inverse() @ opened.frames(look["parts"])["flap"]
    assert D.translation == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert np.linalg.norm(D.log()[3:]) == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize(("name", "live"), [("four_bar", False), ("slider_crank", True)])
def test_a_parameter_that_turns_a_connector_by_rule_is_fixed(name: str, live: bool, tmp_path: Path) -> None:
    (row,) = [row for row in Job(assembly(name), tmp_path).to_json()["parameters"] if row["name"] == "crank_rest"]
    assert row["live"] is live
    assert live or "it turns the connector" in row["why"]
