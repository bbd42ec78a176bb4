"""A finished run is changed by words and by numbers: what is meant changes, nothing else does, and the report proves it."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path
from random import Random
from typing import Any

import pytest

from articad import examples
from articad.agents import edit_report
from articad.agents.edit import edit
from articad.agents.edit_base import with_values
from articad.agents.evidence import examine
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate, replay
from articad.agents.settings import Services
from articad.errors import AgentError, PlanError, ReadError
from articad.kernels.kernel import BuildCache
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.record import assembly_of, run_report
from articad.runs.run import Run, differences
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_SCRIPTS, fenced, flap

TALLER = {"summary": "The drawer is 20 mm taller.", "touches": ["body", "drawer"], "changes": {"parameters.drawer_height.value": 60}}
THICKER = {"summary": "A thicker flap.", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3}}
QUIET: dict[str, Any] = {"look": False, "inspection": False}


def said(llm: Scripted, step: str) -> str:
    request = next(request for request in llm.requests if request.step == step)
    return "\n".join(part["text"] for message in request.to_json()["messages"] for part in message["content"] if part["type"] == "text")


def edited(base: Run, folder: Path, *answers: Any, text: str = "change it", **options: Any) -> tuple[Run, Scripted]:
    """Edit a run with these answers of the designer."""
    script = {f"edit/{number}": answer if isinstance(answer, str) else json.dumps(answer) for number, answer in enumerate(answers, 1)}
    llm = Scripted(script | options.pop("also", {}))
    made: dict[str, Any] = {"kernel": stories.kernel(), "cache": stories.shared_cache()} | QUIET
    return edit(base, text, llm=llm, out=folder, **stories.settings(**(made | options))), llm


@pytest.fixture(scope="module")
def box(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A sewing box: body, two lids, drawer and knob."""
    folder = tmp_path_factory.mktemp("box") / "run"
    return generate(
        stories.SEWING_BOX_PROMPT,
        llm=stories.sewing_box(),
        out=folder,
        **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **QUIET),
    )


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A plate with a flap."""
    folder = tmp_path_factory.mktemp("plate") / "run"
    return generate(
        stories.FLAP_PROMPT, llm=flap(), out=folder, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **QUIET)
    )


@pytest.fixture(scope="module")
def taller(box: Run, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The box with a taller drawer."""
    return edited(box, tmp_path_factory.mktemp("taller") / "run", TALLER, text="make the drawer 20 mm taller")[0]


# ---------------------------------------------------------------------- what changes, and what does not


def test_a_taller_drawer_rebuilds_the_parts_whose_digest_changed_and_all_other_files_are_equal(box: Run, taller: Run) -> None:
    def digests(run: Run) -> dict[str, Any]:
        return {name: (run.part(name) or {}).get("digests") for name in run.part_names()}

    changed = {name for name in digests(box) if digests(box)[name] != digests(taller)[name]}
    before, after = box.hashes(), taller.hashes()
    unlike = {name.split("/")[1] for name in before | after if name.startswith("parts/") and before.get(name) != after.get(name)}
    fates = {name: row["fate"] for name, row in (taller.edit() or {})["parts"].items()}

    assert changed == unlike == {"body", "drawer"}
    assert {name for name, fate in fates.items() if fate != "untouched"} == changed
    assert fates["body"] == fates["drawer"] == "rebuilt"
    for name in ("knob", "lid_left"):
        for file in ("part.step", "part.npz", "script.py", "part.json", "connectors.json"):
            assert before[f"parts/{name}/{file}"] == after[f"parts/{name}/{file}"]
    assert (taller.part("drawer") or {})["shape"]["bbox_mm"][1][2] == pytest.approx(
        (box.part("drawer") or {})["shape"]["bbox_mm"][1][2] + 20
    )
    assert (taller.checks() or {})["ok"]


def test_the_findings_tell_what_has_changed(taller: Run) -> None:
    findings = (taller.edit() or {})["findings"]
    told = {finding["where"]: finding["message"] for finding in findings}

    assert told["parameters.drawer_height.value"] == "40 → 60."
    assert "dimensions.height" in told["parts.drawer"]
    assert set(told) == {"parameters.drawer_height.value", "parts.drawer", "parts.body"}
    assert {finding["code"] for finding in findings} == {"I_EDITED", "I_PART_EDITED"}
    assert run_report(taller)["edit"]["summary"] == TALLER["summary"]


def test_only_touched_pairs_are_looked_at_again_and_the_report_is_that_of_a_whole_check(box: Run, tmp_path: Path) -> None:
    changes = {"parts.knob.dimensions.length": 20, "parts.knob.envelope_mm": [18, 20, 18]}
    run, _ = edited(box, tmp_path / "run", {"summary": "x", "touches": ["knob"], "changes": changes})
    whole = examine(assembly_of(run, cache=stories.shared_cache()))
    counted = (run.edit() or {})["pairs"]

    def told(pairs: list[dict[str, Any]]) -> list[str]:
        return sorted(json.dumps(pair, sort_keys=True) for pair in pairs)

    assert told((run.checks() or {})["pairs"]) == told(whole.checks.to_json()["pairs"])
    assert (run.checks() or {})["findings"] == whole.checks.to_json()["findings"]
    with_knob = [pair for pair in whole.checks.pairs if "knob" in pair.parts]
    assert counted == {"carried": len(whole.checks.pairs) - len(with_knob), "checked": len(with_knob)}
    assert counted["carried"] > len(with_knob) > 0


@pytest.fixture(scope="module")
def flush(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A plate whose flap lies on it."""
    plan = json.loads(json.dumps(FLAP_PLAN))
    plan["parameters"][0]["value"] = 0
    plan["parts"][1]["dimensions"]["lift"] = 0
    lower = FLAP_SCRIPTS["flap"].replace('d["lift"]', "0")
    planned = FLAP_SCRIPTS["plate"].replace('(0, d["side"] / 2, d["side"])', 'part.connectors["axis"].o')
    llm = flap(design__1=json.dumps(plan), part__flap__1=fenced(lower), part__plate__1=fenced(planned))
    folder = tmp_path_factory.mktemp("flush") / "run"
    return generate(
        stories.FLAP_PROMPT, llm=llm, out=folder, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **QUIET)
    )


def test_a_pair_whose_solids_are_the_same_is_looked_at_again_where_they_stand_otherwise(flush: Run, tmp_path: Path) -> None:
    deeper = {"parts.plate.connectors.axis.o": [0, 5, 9], "parts.flap.rest_pose.at": [0, 0, 9]}
    change = {"summary": "x", "touches": ["plate"], "changes": deeper}
    run, _ = edited(flush, tmp_path / "run", change, rounds=1)

    assert (run.part("plate") or {})["shape"] == (flush.part("plate") or {})["shape"]
    assert (flush.checks() or {})["ok"]
    assert [finding["code"] for finding in (run.checks() or {})["findings"]] == ["E_STATIC_OVERLAP"]
    assert (run.edit() or {})["pairs"]["carried"] == 0


def test_a_pair_whose_joint_turns_farther_is_looked_at_again(flush: Run, tmp_path: Path) -> None:
    change = {"summary": "x", "touches": ["plate", "flap"], "changes": {"joints.hinge.angle_deg": [-20, 90]}}
    run, _ = edited(flush, tmp_path / "run", change, rounds=1)

    assert "E_MOTION_COLLISION" in [finding["code"] for finding in (run.checks() or {})["findings"]]
    assert {name: row["different"].keys() for name, row in (run.edit() or {})["parts"].items()} == {
        "plate": {"brief.json", "part.json"},
        "flap": {"brief.json", "part.json"},
    }


def test_the_run_that_is_edited_stays_as_it_is_and_is_not_needed_any_more(plate: Run, tmp_path: Path) -> None:
    before = plate.hashes()
    base = Run.view(shutil.copytree(plate.path, tmp_path / "base"))
    run, _ = edited(base, tmp_path / "run", THICKER)
    assert plate.hashes() == base.hashes() == before
    shutil.rmtree(base.path)

    again = replay(
        run.path, out=tmp_path / "again", strict=True, services=Services(kernel=stories.kernel(), cache=BuildCache(tmp_path / "empty"))
    )
    assert again.differences == ()


@pytest.mark.slow
def test_of_a_recorded_run_with_gears_only_what_a_number_reaches_is_built_and_looked_at_again(tmp_path: Path) -> None:
    recorded = Run.view(examples.folder("metronome") / "recording")
    cache = BuildCache(tmp_path / "cache")
    run = edit(recorded, values={"scale_z": 96}, out=tmp_path / "run", **stories.settings(kernel=stories.kernel(), cache=cache))
    report = run.edit() or {}
    before, after = recorded.hashes(), run.hashes()
    digests = [{name: (one.part(name) or {}).get("digests") for name in one.part_names()} for one in (recorded, run)]
    changed = {name for name in digests[0] if digests[0][name] != digests[1][name]}
    unlike = {file.split("/")[1] for file in before if file.startswith("parts/") and before[file] != after.get(file)}
    whole = examine(assembly_of(run, cache=cache)).checks.to_json()

    assert changed == unlike == {name for name, row in report["parts"].items() if row["fate"] != "untouched"} == {"scale_plate", "housing"}
    assert sorted(map(json.dumps, (run.checks() or {})["pairs"])) == sorted(map(json.dumps, whole["pairs"]))
    assert (run.checks() or {})["findings"] == whole["findings"]
    assert report["pairs"]["carried"] > report["pairs"]["checked"]


# ---------------------------------------------------------------------- reach


def test_what_a_change_reaches_is_told_from_the_plans_alone() -> None:
    plan = AssemblyPlan.load(examples.folder("wardrobe"))
    reached = edit_report.reach(resolve(plan), resolve(with_values(plan, {"drawer_height": 220})))

    assert {name: how for name, how in reached.items() if how != "mirrored anew"} == {
        "cabinet": "other numbers",
        "door_left": "other numbers",
        "door_right": "follows its source",
        "drawer_lower": "other numbers",
        "drawer_upper": "follows its source",
    }
    assert set(reached) - {"handle_right"} == set(reached) - {name for name, how in reached.items() if how == "mirrored anew"}
    assert edit_report.reach(resolve(plan), resolve(plan)) == {}


def test_an_answer_that_reaches_more_than_it_names_goes_back(plate: Run, tmp_path: Path) -> None:
    wide = {"summary": "x", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3, "parts.plate.dimensions.length": 44}}
    run, llm = edited(plate, tmp_path / "run", wide, THICKER)

    assert "E_EDIT_REACH" in said(llm, "edit/2")
    assert "dimensions.length 40 → 44" in said(llm, "edit/2")
    assert (run.edit() or {})["parts"]["plate"]["fate"] == "untouched"


def test_addresses_that_lead_nowhere_and_plans_that_do_not_hold_go_back(plate: Run, tmp_path: Path) -> None:
    lost = THICKER | {"changes": {"parts.flop.dimensions.thickness": 3}}
    broken = THICKER | {"changes": {"parts.flap.rest_pose.at": [0, 0, 11]}}
    strange = THICKER | {"touches": ["flap", "flop"]}
    _, llm = edited(plate, tmp_path / "run", lost, broken, strange, "no object", THICKER)

    assert "parts.flop" in said(llm, "edit/2")
    assert "E_MATE_OFFSET" in said(llm, "edit/3")
    assert "'flop', which is not a part" in said(llm, "edit/4")
    assert "could not be read" in said(llm, "edit/5")
    with pytest.raises(PlanError, match="E_MATE_OFFSET"):
        edited(plate, tmp_path / "other", broken, designs=1)


def test_a_part_that_is_described_anew_gets_its_own_script_to_change(plate: Run, tmp_path: Path) -> None:
    text = "Box x from 0 to length, y from 0 to side, z from lift to lift + thickness, with a hole of hole_radius through its middle."
    change = {
        "summary": "A hole in the flap.",
        "touches": ["flap"],
        "changes": {"parts.flap.description": text, "parts.flap.dimensions.hole_radius": 2},
    }
    script = FLAP_SCRIPTS["flap"].replace("import Align, Box, Pos", "import Align, Box, Cylinder, Pos")
    script = script.replace(
        "    return", '    shape -= Pos(d["length"] / 2, d["side"] / 2, 0) * Cylinder(d["hole_radius"], 99)\n    return'
    )
    run, llm = edited(plate, tmp_path / "run", change, also={"part/flap/1": fenced(script)})

    assert "earlier specification" in said(llm, "part/flap/1")
    assert FLAP_SCRIPTS["flap"].strip() in said(llm, "part/flap/1")
    assert llm.steps == ["edit/1", "part/flap/1"]
    assert (run.edit() or {})["parts"]["flap"]["fate"] == "rewritten"
    assert (run.part("flap") or {})["shape"]["volume_mm3"] < (plate.part("flap") or {})["shape"]["volume_mm3"]


def test_parts_are_added_and_removed(plate: Run, tmp_path: Path) -> None:
    knob = {
        "name": "knob",
        "material": "steel",
        "description": "Box x from 0 to length, y from 0 to side, z from 0 to side.",
        "dimensions": {"length": 5, "side": 10},
        "rest_pose": {"at": [40, 0, 0]},
        "connectors": [{"name": "face", "kind": "mount_face", "o": [0, 5, 5], "z": [1, 0, 0], "x": [0, 1, 0], "label": "left face"}],
    }
    face = {"kind": "mount_face", "o": [40, 5, 5], "z": [1, 0, 0], "x": [0, 1, 0], "label": "right face"}
    changes = {
        "parts.knob": knob,
        "parts.plate.connectors.face": face,
        "joints.knob": {"type": "fixed", "parent": "plate.face", "child": "knob.face"},
        "parts.flap": None,
        "joints.hinge": None,
        "parts.plate.connectors.axis": None,
        "parameters.lift": None,
        "freedoms": 0,
    }
    change = {"summary": "A knob for a flap.", "touches": ["knob", "plate", "flap"], "changes": changes}
    plain = FLAP_SCRIPTS["plate"]
    scripts = {
        "part/plate/1": plain.replace(
            '"axis": {"o": (0, d["side"] / 2, d["side"]), "z": (0, -1, 0), "x": (1, 0, 0)}', FACE.format('d["length"]')
        ),
        "part/knob/1": plain.replace('"axis": {"o": (0, d["side"] / 2, d["side"]), "z": (0, -1, 0), "x": (1, 0, 0)}', FACE.format("0")),
    }
    run, _ = edited(plate, tmp_path / "run", change, also={step: fenced(script) for step, script in scripts.items()})
    fates = {name: row["fate"] for name, row in (run.edit() or {})["parts"].items()}

    assert fates == {"flap": "removed", "plate": "rewritten", "knob": "new"}
    assert run.part_names() == ("knob", "plate")


FACE = '"face": {{"o": ({}, d["side"] / 2, d["side"] / 2), "z": (1, 0, 0), "x": (0, 1, 0)}}'


def test_a_part_that_only_moves_is_not_touched(plate: Run, tmp_path: Path) -> None:
    moved = {"summary": "x", "touches": [], "changes": {"parts.plate.rest_pose": {"at": [0, 0, 5]}, "parts.flap.rest_pose.at": [0, 0, 15]}}
    run, _ = edited(plate, tmp_path / "run", moved)
    report = run.edit() or {}
    assert {row["fate"] for row in report["parts"].values()} == {"untouched"}
    assert report["pairs"]["checked"] == 0
    assert (run.assembly() or {})["parts"]["flap"]["rest"][2] == 15


def hashes(run: Run, part: str) -> dict[str, str]:
    """Return the sha256 of each file of a part, read from the disk."""
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in (run.path / "parts" / part).iterdir() if file.is_file()}


@pytest.mark.parametrize("seed", range(8))
def test_after_random_edits_the_parts_that_are_called_as_they_were_are_those_with_equal_files(
    plate: Run, tmp_path: Path, seed: int
) -> None:
    random = Random(seed)
    entries: dict[str, tuple[str, Any]] = {
        "parts.flap.dimensions.thickness": ("flap", random.choice([1.5, 2.5, 3])),
        "parts.flap.dimensions.length": ("flap", random.choice([20, 26, 28])),
        "parts.plate.dimensions.length": ("plate", random.choice([42, 44])),
        "parts.plate.rest_pose": ("", {"at": [0, 0, 0]}),
        "joints.hinge.angle_deg": ("plate flap", [0, random.choice([45, 60])]),
        "materials.steel.color": ("", "#204060"),
        "parts.flap.role": ("flap", "a lid"),
    }
    chosen = random.sample(sorted(entries), 3)
    touched = sorted({part for where in chosen for part in entries[where][0].split()})
    answer = {"summary": "x", "touches": touched, "changes": {where: entries[where][1] for where in chosen}}
    scripts = {f"part/{name}/*": fenced(FLAP_SCRIPTS[name]) for name in FLAP_SCRIPTS}

    run, _ = edited(plate, tmp_path / "run", answer, answer, answer, also=scripts)

    report = run.edit() or {}
    alike = {name for name in ("plate", "flap") if hashes(run, name) == hashes(plate, name)}
    assert {name for name, row in report["parts"].items() if row["fate"] in {"untouched", "equal"}} == alike
    assert {name for name, row in report["parts"].items() if not row["different"]} == alike
    assert {f["where"].removeprefix("parts.") for f in report["findings"] if f["code"] == "I_PART_EDITED"}.isdisjoint(alike)


def test_a_collision_goes_back_to_who_changes_the_plan(plate: Run, tmp_path: Path) -> None:
    deep = THICKER | {"changes": {"parameters.lift.value": -1}}
    run, llm = edited(plate, tmp_path / "run", deep, THICKER)

    assert "E_STATIC_OVERLAP" in said(llm, "edit/2")
    assert (run.checks() or {})["ok"]
    assert (run.round(1) or {})["kept"] == ["plate", "flap"]
    assert (run.edit() or {})["changes"] == [{"where": "parts.flap.dimensions.thickness", "before": 2, "after": 3}]


def test_files_that_were_changed_by_hand_are_not_taken_for_untouched(plate: Run, tmp_path: Path) -> None:
    base = Run.view(shutil.copytree(plate.path, tmp_path / "base"))
    with (base.path / "parts/plate/part.step").open("ab") as stream:
        stream.write(b"\n")
    run, _ = edited(base, tmp_path / "run", THICKER)
    report = run.edit() or {}

    assert not report["ok"]
    assert [f["code"] for f in report["findings"] if f["severity"] == "error"] == ["E_EDIT_UNEQUAL"]
    assert report["parts"]["plate"]["fate"] == "unequal"
    assert not run_report(run)["ok"]


# ---------------------------------------------------------------------- numbers alone


def test_numbers_need_no_model(plate: Run, tmp_path: Path) -> None:
    run = edit(plate, values={"lift": 2}, out=tmp_path / "run", **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache()))
    report = run.edit() or {}

    assert report["changes"] == [{"where": "parameters.lift.value", "before": 1, "after": 2}]
    assert {name: row["fate"] for name, row in report["parts"].items()} == {"plate": "untouched", "flap": "rebuilt"}
    assert run.replies() == ()
    assert replay(
        run.path, out=tmp_path / "again", strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache())
    ).ok


def test_numbers_that_do_not_hold_are_refused(plate: Run, tmp_path: Path) -> None:
    with pytest.raises(PlanError, match="lofd"):
        edit(plate, values={"lofd": 2}, out=tmp_path / "a")
    with pytest.raises(ReadError, match="No change is given"):
        edit(plate, out=tmp_path / "b")
    with pytest.raises(AgentError, match="needs a model"):
        edit(plate, "wider", out=tmp_path / "c", **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache()))


def test_an_edit_can_be_edited_and_interrupted(plate: Run, tmp_path: Path) -> None:
    first, _ = edited(plate, tmp_path / "first", THICKER, text="a thicker flap")
    longer = {"summary": "x", "touches": ["plate"], "changes": {"parts.plate.dimensions.length": 44}}
    second, llm = edited(first, tmp_path / "second", longer, text="a longer plate")
    assert f"{stories.FLAP_PROMPT}\n\nChanged since: a thicker flap" in said(llm, "edit/1")

    with pytest.raises(AgentError):
        edited(first, tmp_path / "third", text="a longer plate")
    third, _ = edited(first, tmp_path / "third", longer, text="a longer plate")
    resumed, nobody = edited(first, tmp_path / "third", text="a longer plate")
    assert nobody.requests == []
    assert list(differences(second, third)) == list(differences(second, resumed)) == []
