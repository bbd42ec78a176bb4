"""The whole line with scripted models and the real kernel: good days, bad days, crashes and repeats."""

from __future__ import annotations

import copy
import json
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from articad.agents import design as design_module
from articad.agents.excerpt import compact
from articad.agents.llm import Budget, Replay, Reply, Request, Scripted, transport_error
from articad.agents.pipeline import generate, replay, resume
from articad.agents.settings import Services
from articad.errors import BudgetError, ContractError, OutputError, PlanError, ReplayMissError, RunError, TransportError
from articad.runs.run import Run, differences
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_PROMPT, FLAP_SCRIPTS, SEWING_BOX_PROMPT, fenced, flap

PNG = b"\x89PNG\r\n\x1a\n" + bytes(16)


def made(tmp_path: Path, llm: Any, name: str = "run", prompt: str = FLAP_PROMPT, **options: Any) -> Run:
    options = {"look": False, "inspection": False} | options
    return generate(
        prompt, llm=llm, out=tmp_path / name, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **options)
    )


def said(request: Request) -> str:
    return "\n".join(part["text"] for message in request.to_json()["messages"] for part in message["content"] if part["type"] == "text")


def of(llm: Scripted, step: str) -> Request:
    return next(request for request in llm.requests if request.step == step)


def changed(**changes: Any) -> dict[str, Any]:
    plan = copy.deepcopy(FLAP_PLAN)
    plan.update(changes)
    return plan


def with_lift(value: float, note: str = "") -> str:
    plan = changed(parameters=[{"name": "lift", "value": value}])
    plan["parts"][1]["description"] += note
    return json.dumps(plan)


# ---------------------------------------------------------------------- good days


def test_a_good_first_shot_takes_one_call_for_the_plan_and_one_for_each_part_that_is_not_derived(tmp_path: Path) -> None:
    llm = stories.sewing_box()
    run = made(tmp_path, llm, prompt=SEWING_BOX_PROMPT)

    assert llm.steps[:2] == ["requirements", "design/1"]
    assert sorted(llm.steps[2:]) == ["part/body/1", "part/drawer/1", "part/knob/1", "part/lid_left/1"]
    assert run.part_names() == ("body", "drawer", "knob", "lid_left", "lid_right")
    checks = run.checks()
    assert checks is not None
    assert checks["ok"]
    assert checks["findings"] == []
    in_motion = {(tuple(pair["over"]), pair["strength"]["kind"]) for pair in checks["pairs"] if pair["over"] != "rest"}
    assert in_motion == {((joint,), "sampled") for joint in ("lid_left", "lid_right", "drawer")}
    assert (run.path / "export/urdf/sewing_box.urdf").is_file()
    assert (run.path / "export/mjcf/sewing_box.xml").is_file()
    assert json.loads((run.path / "parts/lid_right/part.json").read_text())["derived_from"] == "lid_left"


def test_parts_are_asked_for_side_by_side(tmp_path: Path) -> None:
    both = threading.Barrier(2, timeout=20)

    def when_both_ask(name: str) -> Any:
        def answer(_: Request) -> str:
            both.wait()
            return fenced(FLAP_SCRIPTS[name])

        return answer

    made(tmp_path, flap(part__plate__1=when_both_ask("plate"), part__flap__1=when_both_ask("flap")))


def test_pictures_reach_the_analysis_and_the_design_and_a_parts_picture_its_own_requests_only(tmp_path: Path) -> None:
    llm = flap()
    made(tmp_path, llm, images=[PNG], part_images={"flap": PNG + b"2"})

    assert {request.step for request in llm.requests if request.has_images} == {"requirements", "design/1", "part/flap/1"}
    assert len(Run.view(tmp_path / "run").request.images) == 2


# ---------------------------------------------------------------------- answers without form


def test_malformed_json_goes_back_with_what_is_wrong_and_is_mended(tmp_path: Path) -> None:
    llm = flap(requirements="Sure! {", requirements__2=stories.requirements(), design__1='{"schema": ', design__2=json.dumps(FLAP_PLAN))
    made(tmp_path, llm)

    assert llm.steps[:4] == ["requirements", "requirements/2", "design/1", "design/2"]
    assert "not one JSON object" in said(of(llm, "requirements/2"))
    assert "Sure! {" in said(of(llm, "requirements/2"))
    assert "not one JSON object" in said(of(llm, "design/2"))


def test_requirements_that_miss_fields_are_told_which(tmp_path: Path) -> None:
    llm = flap(requirements='{"name": "x"}', requirements__2=stories.requirements())
    made(tmp_path, llm)

    assert "components: Field required" in said(of(llm, "requirements/2"))


def test_a_model_that_never_finds_the_form_is_given_up(tmp_path: Path) -> None:
    llm = Scripted({"requirements*": "I cannot do that."})
    with pytest.raises(OutputError) as caught:
        made(tmp_path, llm)
    assert caught.value.findings.codes == ("E_REPLY_SCHEMA",)
    assert caught.value.raw == "I cannot do that."
    assert llm.steps == ["requirements", "requirements/2", "requirements/3"]


def test_an_answer_without_a_script_is_an_attempt(tmp_path: Path) -> None:
    llm = flap(part__flap__1="I would rather not.", part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    made(tmp_path, llm)

    assert "no ```python block" in said(of(llm, "part/flap/2"))


# ---------------------------------------------------------------------- plans and scripts with faults


def test_findings_of_a_plan_go_back_with_the_plan_until_it_validates(tmp_path: Path) -> None:
    wrong = changed(freedoms=3)
    wrong["joints"][0]["parent"] = "plate.axle"
    llm = flap(design__1=json.dumps(wrong), design__2=json.dumps(changed(freedoms=2)), design__3=json.dumps(FLAP_PLAN))
    made(tmp_path, llm)
    second, third = said(of(llm, "design/2")), said(of(llm, "design/3"))

    assert "E_CONNECTOR_UNKNOWN joints.hinge" in second
    assert compact(wrong) in second
    assert "E_DOF_MISMATCH" in third
    assert compact(wrong) not in third


def test_a_plan_that_never_validates_ends_with_its_findings_and_keeps_what_was_understood(tmp_path: Path) -> None:
    llm = flap(**{f"design__{n}": json.dumps(changed(freedoms=3)) for n in range(1, 4)})
    with pytest.raises(PlanError) as caught:
        made(tmp_path, llm, designs=3)
    assert "E_DOF_MISMATCH" in caught.value.findings.codes
    assert Run.view(tmp_path / "run").requirements() is not None


def test_a_script_that_fails_twice_is_repaired_with_its_trace_and_its_text(tmp_path: Path) -> None:
    crash = FLAP_SCRIPTS["flap"].replace("return shape", "shape = shape.no_such_thing()\n    return shape")
    misnamed = FLAP_SCRIPTS["flap"].replace('"axis"', '"axle"')
    llm = flap(part__flap__1=fenced(crash), part__flap__2=fenced(misnamed), part__flap__3=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)
    second, third = said(of(llm, "part/flap/2")), said(of(llm, "part/flap/3"))

    assert llm.steps.count("part/plate/1") == 1
    assert "no_such_thing" in second
    assert "E_SCRIPT_ERROR" in second
    assert "E_CONNECTOR_MISSING" in third
    assert "E_CONNECTOR_EXTRA" in third
    assert '"axle"' in third
    assert "no_such_thing" not in third
    assert str(tmp_path) not in second + third
    attempts = sorted(path.name for path in (run.path / "attempts").iterdir())
    assert attempts == ["flap-1", "flap-2"]
    assert run.script("flap") == (FLAP_SCRIPTS["flap"].strip() + "\n").encode()


def test_a_repair_shows_what_the_script_had_made_and_the_run_keeps_the_picture(tmp_path: Path) -> None:
    two = FLAP_SCRIPTS["flap"].replace("return shape,", "return shape + Pos(100, 0, 0) * shape,")
    llm = flap(part__flap__1=fenced(two), part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)
    asked = of(llm, "part/flap/2")
    recipe = asked.to_json()["messages"][-1]["content"][-1]["recipe"]

    assert "E_NOT_ONE_SOLID" in said(asked)
    assert recipe["views"] == ["iso", "front", "right", "top", "iso_back_left", "iso_below_left"]
    assert len(recipe["build"]) == 64
    assert (run.path / "attempts/flap-1/partial.png").read_bytes() == asked.messages[-1].parts[-1].content  # type: ignore[union-attr]


def test_a_part_built_beside_its_connector_is_built_again(tmp_path: Path) -> None:
    beside = FLAP_SCRIPTS["flap"].replace('"o": (0,', '"o": (7,')
    llm = flap(part__flap__1=fenced(beside), part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    made(tmp_path, llm)

    assert "'axis' was built 7 mm off the axis" in said(of(llm, "part/flap/2"))


def test_a_part_that_cannot_be_made_is_named_and_the_others_are_finished(tmp_path: Path) -> None:
    wrong = ("return None", "return 1, 2", "raise ValueError(part.name)", "return part")
    llm = flap(**{f"part__flap__{n}": fenced(f"def build(part):\n    {line}") for n, line in enumerate(wrong, 1)})
    with pytest.raises(ContractError, match="1 of 2 parts could not be made") as caught:
        made(tmp_path, llm, rounds=1)
    assert caught.value.parts == ("flap",)
    assert "part/plate/1" in llm.steps
    assert llm.steps.count("part/flap/4") == 1
    assert "part/flap/5" not in llm.steps


# ---------------------------------------------------------------------- the edge back


def test_what_the_checks_find_goes_to_the_designer_and_only_the_changed_part_is_asked_for_again(tmp_path: Path) -> None:
    note = " The lift keeps it clear of the plate."
    llm = flap(design__1=with_lift(-1.5), design__2=with_lift(1, note), part__flap__2=fenced(FLAP_SCRIPTS["flap"]))
    run = made(tmp_path, llm)

    assert "OVERLAP" in said(of(llm, "design/2"))
    assert sorted(llm.steps[2:]) == ["design/2", "part/flap/1", "part/flap/2", "part/plate/1"]
    assert (run.checks() or {})["ok"]
    assert sorted(path.name for path in (run.path / "plans").iterdir()) == ["0.json", "1.json"]


def test_a_collision_in_motion_goes_to_the_designer_with_the_joint_and_the_place(tmp_path: Path) -> None:
    digging = changed()
    digging["joints"][0]["angle_deg"] = [-90, 90]
    digging["parts"][1]["rest_pose"] = {"at": [-5, 0, 10]}
    digging["parts"][1]["connectors"][0]["o"] = [5, 5, 0]
    where_planned = FLAP_SCRIPTS["flap"].replace('(0, d["side"] / 2, 0)', 'part.connectors["axis"].o')
    llm = flap(design__1=json.dumps(digging), design__2=json.dumps(FLAP_PLAN), part__flap__1=fenced(where_planned))
    run = made(tmp_path, llm)
    told = said(of(llm, "design/2"))

    assert "E_MOTION_COLLISION joints.hinge: plate and flap collide in motion: at hinge = " in told
    assert (run.checks() or {})["ok"]


def test_a_change_of_numbers_alone_keeps_every_script(tmp_path: Path) -> None:
    llm = flap(design__1=with_lift(-1.5), design__2=with_lift(1))
    run = made(tmp_path, llm)

    assert sorted(llm.steps[2:]) == ["design/2", "part/flap/1", "part/plate/1"]
    assert (run.checks() or {})["ok"]
    assert json.loads((run.path / "parts/flap/brief.json").read_text())["dimensions"]["lift"] == 1


def test_what_is_left_after_the_last_round_stays_in_the_report(tmp_path: Path) -> None:
    run = made(tmp_path, flap(design__1=with_lift(-1.5), design__2=with_lift(-1.4)), rounds=2)

    checks = run.checks()
    assert checks is not None
    assert not checks["ok"]
    assert (run.path / "export/urdf/flap.urdf").is_file()


# ---------------------------------------------------------------------- money, crashes, providers


def test_a_budget_that_runs_out_keeps_the_work_and_a_larger_one_goes_on_without_repeating(tmp_path: Path) -> None:
    first, second = flap(), flap()
    with pytest.raises(BudgetError, match="3 calls") as caught:
        made(tmp_path, Budget(first, calls=3))
    assert caught.value.findings.codes == ("E_BUDGET",)
    run = made(tmp_path, Budget(second, calls=3))

    assert len(first.steps) == 3
    assert len(second.steps) == 1
    assert (run.checks() or {})["ok"]
    assert list(differences(run, made(tmp_path, flap(), "undisturbed"))) == []


def test_a_provider_that_fails_in_one_part_leaves_the_other_finished(tmp_path: Path) -> None:
    def down(_: Request) -> Reply:
        raise transport_error("E_TRANSPORT", "The provider is down.", "Wait.")

    llm = flap(part__flap__1=down)
    with pytest.raises(TransportError, match="provider is down"):
        made(tmp_path, llm)
    later = flap()
    made(tmp_path, later)

    assert later.steps == ["part/flap/1"]


def test_a_killed_run_goes_on_with_no_call_repeated_and_ends_like_one_that_was_not(tmp_path: Path) -> None:
    crash = FLAP_SCRIPTS["flap"].replace("return shape", "shape = shape.no_such_thing()\n    return shape")
    script = f"""
import os, signal
from pathlib import Path
from tests.agents.stories import *
from articad.agents.pipeline import generate

def dies(_):
    os.kill(os.getpid(), signal.SIGKILL)

llm = flap(part__flap__1=fenced({crash!r}), part__flap__2=dies)
folder = Path({str(tmp_path)!r})
generate(FLAP_PROMPT, llm=llm, out=folder / "run", **settings(kernel=kernel(), cache=cache(folder), jobs=1, look=False, inspection=False))
"""
    killed = subprocess.run([sys.executable, "-c", script], check=False)
    assert killed.returncode == -signal.SIGKILL
    done = set(Run.view(tmp_path / "run").replies())
    answers = {"part__flap__1": fenced(crash), "part__flap__2": fenced(FLAP_SCRIPTS["flap"])}
    llm = flap(**answers)
    run = made(tmp_path, llm)

    assert {"requirements", "design/1", "part/flap/1"} <= done
    assert "part/flap/2" in llm.steps
    assert done.isdisjoint(llm.steps)
    assert list(differences(run, made(tmp_path, flap(**answers), "undisturbed"))) == []


def test_a_run_is_gone_on_with_by_its_folder_alone(tmp_path: Path) -> None:
    with pytest.raises(BudgetError):
        made(tmp_path, Budget(flap(), calls=3))
    llm = flap()
    run = resume(tmp_path / "run", llm=llm, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))

    assert len(llm.steps) == 1
    assert list(differences(run, made(tmp_path, flap(), "undisturbed"))) == []
    finished = resume(tmp_path / "run", services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))
    assert finished.hashes() == run.hashes()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"repairs": None}, "lacks options: repairs"),
        ({"formats": "urdf", "rounds": "3"}, "rounds, formats"),
        ({"task": "build"}, "articad build"),
        ({"kernel": 3}, "options.kernel is missing or is something else"),
    ],
)
def test_a_request_that_somebody_else_wrote_is_not_trusted(tmp_path: Path, change: dict[str, Any], said: str) -> None:
    run = made(tmp_path, flap())
    file = run.path / "request.json"
    request = json.loads(file.read_text())
    request["options"] = {key: value for key, value in (request["options"] | change).items() if value is not None}
    file.write_text(json.dumps(request))
    with pytest.raises(RunError, match=said) as caught:
        resume(run.path, llm=flap())
    assert caught.value.findings.codes == ("E_RUN",)
    with pytest.raises(RunError, match=said):
        replay(run.path, out=tmp_path / "again")


def test_a_finished_run_asks_nothing_when_called_again_and_another_request_is_refused(tmp_path: Path) -> None:
    run = made(tmp_path, flap())
    before = run.hashes()
    again = Scripted({})
    made(tmp_path, again)

    assert again.steps == []
    assert run.hashes() == before
    with pytest.raises(RunError, match="different request"):
        made(tmp_path, again, prompt="something else")


# ---------------------------------------------------------------------- replay


def test_a_replay_makes_every_file_but_the_trace_byte_for_byte(tmp_path: Path) -> None:
    crash = FLAP_SCRIPTS["flap"].replace("return shape", "shape = shape.no_such_thing()\n    return shape")
    run = made(tmp_path, flap(part__flap__1=fenced(crash), part__flap__2=fenced(FLAP_SCRIPTS["flap"])), images=[PNG])
    other = tmp_path / "other"
    result = replay(run.path, out=other / "run", strict=True, services=Services(kernel=stories.kernel(), cache=stories.cache(other)))

    assert result.differences == ()
    assert result.ok
    assert len(result.findings) == 0
    assert len(result.run.hashes()) == len(run.hashes()) > 20


def test_a_prompt_that_drifted_is_reported_and_strictly_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = made(tmp_path, flap())
    monkeypatch.setattr(design_module, "_instructions", lambda: "Design it.")
    result = replay(run.path, out=tmp_path / "again", services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))

    assert result.findings.codes == ("I_PROMPT_DRIFT",)
    assert result.differences == ("llm/design.1.json",)
    assert result.results_that_differ == ()
    assert result.ok
    with pytest.raises(ReplayMissError, match="design/1"):
        replay(run.path, out=tmp_path / "strict", strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))


def test_a_recording_without_an_answer_says_which(tmp_path: Path) -> None:
    run = made(tmp_path, flap())
    (run.path / "llm/part.flap.1.json").unlink()
    with pytest.raises(ReplayMissError, match="part/flap/1"):
        replay(run.path, out=tmp_path / "again", services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))


def test_replay_is_a_model_like_any_other(tmp_path: Path) -> None:
    run = made(tmp_path, flap())
    again = made(tmp_path, Replay(run.path, strict=True), "again")

    assert list(differences(run, again)) == []
