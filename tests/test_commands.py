"""Each command does its job on a small product: a box with a hinged lid and its mirror image."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from articad import cli, examples
from articad.commands import models
from articad.commands.options import FORMATS
from articad.kernels.choice import kernel_named
from articad.runs.run import Run
from tests.agents import stories

PLAN: dict[str, Any] = {
    "schema": "articad.plan/1",
    "name": "chest",
    "ground": "box",
    "freedoms": 1,
    "parameters": [{"name": "width", "value": 60, "min": 40, "max": 100}],
    "materials": [{"name": "oak", "density_kg_m3": 700, "color": "#b08050"}],
    "parts": [
        {
            "name": "box",
            "material": "oak",
            "description": "Block width x 40 x 20, its top at z = 0.",
            "dimensions": {"width": "width"},
            "envelope_mm": ["width", 40, 20],
            "connectors": [{"name": "hinge", "o": [0, 20, 0.2], "z": [1, 0, 0], "x": [0, 1, 0], "label": "hinge"}],
        },
        {
            "name": "lid",
            "material": "oak",
            "description": "Plate width x 40 x 5 with the hinge at its lower back edge.",
            "dimensions": {"width": "width"},
            "rest_pose": {"at": [0, 20, 0.2]},
            "connectors": [{"name": "hinge", "o": [0, 0, 0], "z": [1, 0, 0], "x": [0, 1, 0], "label": "hinge"}],
        },
    ],
    "joints": [{"name": "hinge", "type": "revolute", "parent": "box.hinge", "child": "lid.hinge", "angle_deg": [-100, 0]}],
}
BOX = """\
from build123d import Box, Pos

def build(part):
    return Pos(0, 0, -10) * Box(part.dimensions["width"], 40, 20), {"hinge": {"o": (0, 20, 0.2), "z": (1, 0, 0), "x": (0, 1, 0)}}
"""
LID = """\
from build123d import Box, Pos

def build(part):
    return Pos(0, -20, 2.5) * Box(part.dimensions["width"], 40, 5), {"hinge": {"o": (0, 0, 0), "z": (1, 0, 0), "x": (0, 1, 0)}}
"""


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


def write_chest(folder: Path) -> Path:
    """Write the plan with its part scripts into a new folder."""
    (folder / "parts").mkdir(parents=True)
    (folder / "plan.json").write_text(json.dumps(PLAN))
    (folder / "parts" / "box.py").write_text(BOX)
    (folder / "parts" / "lid.py").write_text(LID)
    return folder


@pytest.fixture
def chest(tmp_path: Path) -> Path:
    """The folder of a plan with its scripts."""
    return write_chest(tmp_path / "chest")


@pytest.fixture
def report(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    """Run a command with --json, with a kernel that all tests share, and return its exit code and its report."""

    def shared(name: str, **options: Any) -> Any:
        return stories.kernel() if name == "build123d" else kernel_named(name, **options)

    monkeypatch.setattr("articad.runs.record.kernel_named", shared)
    monkeypatch.setattr("articad.agents.settings.kernel_named", shared)

    def run(*arguments: object) -> tuple[int, dict[str, Any]]:
        code = cli.main([*map(str, arguments), "--json"])
        return code, json.loads(capsys.readouterr().out)

    return run


def test_build_makes_a_whole_run_and_says_where(chest: Path, tmp_path: Path, report: Any) -> None:
    out = tmp_path / "out"
    code, built = report("build", chest, "--out", out)
    assert (code, built["schema"], built["ok"], built["run"]) == (0, "articad.build/1", True, str(out))
    assert built["assembly"]["parts"]["box"]["volume_mm3"] == pytest.approx(60 * 40 * 20)
    assert built["assembly"]["parts"]["box"]["mass_kg"] == pytest.approx(60 * 40 * 20 * 700e-9)
    assert built["checks"]["ok"]
    files = {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}
    part = {
        f"parts/lid/{name}"
        for name in ("script.py", "brief.json", "part.json", "connectors.json", "part.brep", "part.step", "part.stl", "part.npz")
    }
    assert part <= files
    assert {"request.json", "plan.json", "plans/0.json", "assembly.json", "checks.json", "trace.jsonl"} <= files
    assert {"export/urdf/chest.urdf", "export/mjcf/chest.xml", "export/urdf/losses.json"} <= files
    assert (out / "parts" / "lid" / "script.py").read_text() == LID


def test_build_again_is_the_same_byte_for_byte(chest: Path, tmp_path: Path, report: Any) -> None:
    for name in ("first", "second"):
        assert report("build", chest, "--out", tmp_path / name)[0] == 0
    assert Run.view(tmp_path / "first").hashes() == Run.view(tmp_path / "second").hashes()


def test_a_run_that_was_forced_to_build_anew_holds_the_kernels_files_too(chest: Path, tmp_path: Path, report: Any) -> None:
    report("build", str(chest), "--out", str(tmp_path / "run"), "--force", "--no-pictures")

    for name in ("box", "lid"):
        assert {"part.brep", "part.step", "part.npz"} <= {file.name for file in (tmp_path / "run" / "parts" / name).iterdir()}


def test_build_prints_parts_what_is_proven_and_what_to_open(chest: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["build", str(chest), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    for words in (
        "box",
        "48000.0",
        "chest: 2 parts, 1 joint, 1 freedom",
        "No interference at rest (",
        "Motion not proven: articad certify",
        "chest.urdf",
        "Run: ",
        "Open: articad show",
    ):
        assert words in told


def test_a_complete_build_certifies_and_writes_every_format_in_few_lines(
    chest: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["build", str(chest), "--out", str(tmp_path / "run"), "--complete"]) == 0
    printed = capfd.readouterr()
    lines = [line for line in (printed.out + printed.err).splitlines() if line]
    assert len(lines) <= 15, lines
    run = Run.open(tmp_path / "run")
    exports = run.exports()
    assert set(exports) == set(FORMATS)
    told = next(line for line in lines if line.startswith("Files in "))
    assert all(str(Path(export["main"]).relative_to(run.path)) in told for export in exports.values())
    assert told.endswith("(urdf and mjcf: loaded and held at rest in MuJoCo)")
    assert any(line.startswith("Motion certified") for line in lines)
    assert any(line.endswith("accepted by its checker.") for line in lines)
    assert not (tmp_path / "run" / "report.html").exists()


def test_a_complete_build_that_overlaps_at_rest_stops_there(chest: Path, tmp_path: Path, report: Any) -> None:
    (chest / "parts" / "lid.py").write_text(LID.replace("2.5)", "-2.5)"))
    code, built = report("build", chest, "--out", tmp_path / "run", "--complete")
    assert (code, built["ok"], built["exports"], "certificate" in built, "verification" in built) == (1, False, {}, False, False)
    assert "E_STATIC_OVERLAP" in {finding["code"] for finding in built["checks"]["findings"]}


def test_set_moves_the_whole_assembly(chest: Path, tmp_path: Path, report: Any) -> None:
    code, built = report("build", chest, "--set", "width=80", "--out", tmp_path / "out")
    assert code == 0
    assert built["assembly"]["parts"]["lid"]["volume_mm3"] == pytest.approx(80 * 40 * 5)


def test_an_unknown_parameter_is_named_with_the_one_meant(chest: Path, tmp_path: Path, report: Any) -> None:
    code, failed = report("build", chest, "--set", "widht=80", "--out", tmp_path / "out")
    assert code == 3
    assert "Did you mean 'width'?" in failed["findings"][0]["hint"]


def test_a_failing_script_is_an_error_with_its_line_and_an_earlier_run_stays(chest: Path, tmp_path: Path, report: Any) -> None:
    out = tmp_path / "out"
    assert report("build", chest, "--out", out)[0] == 0
    before = Run.view(out).hashes()
    (chest / "parts" / "lid.py").write_text("def build(part):\n    return 1 / 0\n")
    code, failed = report("build", chest, "--out", out)
    assert (code, failed["schema"]) == (3, "articad.error/1")
    assert [finding["code"] for finding in failed["findings"]] == ["E_SCRIPT_ERROR"]
    assert "line 2" in failed["findings"][0]["message"] + failed["findings"][0]["where"]
    assert Run.view(out).hashes() == before


def test_a_collision_ends_with_1_and_its_finding(chest: Path, tmp_path: Path, report: Any) -> None:
    (chest / "parts" / "lid.py").write_text(LID.replace("Pos(0, -20, 2.5)", "Pos(0, -20, -5)"))
    code, built = report("build", chest, "--out", tmp_path / "out")
    assert code == 1
    assert not built["checks"]["ok"]
    assert [pair["verdict"] for pair in built["checks"]["pairs"]] == ["overlap"]


def test_motion_is_checked_as_strongly_as_was_asked(chest: Path, tmp_path: Path, report: Any) -> None:
    kinds = {}
    for verify in ("rest", "sampled", "certified"):
        code, built = report("build", chest, "--verify", verify, "--out", tmp_path / verify)
        assert (code, built["ok"]) == (0, True)
        kinds[verify] = {pair["strength"]["kind"] for pair in built.get("certificate", built["checks"])["pairs"]}
    assert kinds["rest"] <= kinds["sampled"] <= {"sampled"}
    assert kinds["certified"] == {"certified"}


def test_a_lid_that_opens_through_its_box_is_not_certified(chest: Path, tmp_path: Path, report: Any) -> None:
    plan = PLAN | {"joints": [PLAN["joints"][0] | {"angle_deg": [-100, 20]}]}
    (chest / "plan.json").write_text(json.dumps(plan))
    code, built = report("build", chest, "--verify", "certified", "--out", tmp_path / "out")
    assert code == 1
    assert not built["certificate"]["ok"]
    assert built["checks"]["ok"]


def test_a_certificate_is_verified_and_a_forged_one_refuted(chest: Path, tmp_path: Path, report: Any) -> None:
    out = tmp_path / "out"
    assert report("build", chest, "--out", out)[0] == 0
    code, certified = report("certify", out, "--budget", "60")
    assert (code, certified["ok"]) == (0, True)
    code, verified = report("verify-certificate", out / "certificate.json")
    proven = "Proven while all of these joints move at once, each over its whole range: hinge."
    alone = "It was compared with no product: to hold it against the parts and joints of a run, name the run's folder."
    assert (code, verified["stated"]) == (0, [proven, alone])
    code, verified = report("verify-certificate", out)
    assert (code, verified["stated"]) == (0, [proven, "Its parts and joints are those that the run records."])
    code, loose = report("certify", out, "--budget", "60", "--tolerance-class", "f")
    assert loose["tolerance"]["class"] == "f"
    assert code == (0 if loose["ok"] else 1)
    assert loose["ok"] or {finding["code"] for finding in loose["findings"]} == {"E_TOLERANCE"}
    assert report("verify-certificate", out)[1]["ok"]
    unasked = certified | {"asked": [], "together": False, "ok": False}
    unasked["pairs"] = [pair | {"strength": {"kind": "waived", "reason": "felt"}} for pair in certified["pairs"]]
    (out / "certificate.json").write_text(json.dumps(unasked))
    code, verified = report("verify-certificate", out / "certificate.json")
    assert code == 0
    assert [line.partition(":")[0] for line in verified["stated"]] == [
        "The certificate is not ok",
        "These joints were not requested",
        *["Waived, so not checked"] * len(certified["pairs"]),
        "It was compared with no product",
    ]
    certified["claims"] = certified["claims"][:-1]
    (out / "certificate.json").write_text(json.dumps(certified))
    code, verified = report("verify-certificate", out)
    assert (code, verified["ok"]) == (1, False)
    assert verified["faults"]
    (out / "certificate.json").unlink()
    code, refused = report("verify-certificate", out)
    assert code == 3
    assert f"articad certify {out}" in json.dumps(refused)


def test_a_genuine_certificate_of_another_product_is_refuted(chest: Path, tmp_path: Path, report: Any) -> None:
    mine, other = tmp_path / "mine", tmp_path / "other"
    for out, more in ((mine, ()), (other, ("--set", "width=70"))):
        assert report("build", chest, "--out", out, *more)[0] == 0
        assert report("certify", out, "--budget", "60")[0] == 0
        assert report("verify-certificate", out)[1]["ok"]
    for name in ("certificate.json", "certificate"):
        (mine / name).rename(tmp_path / name)
        (other / name).rename(mine / name)
    code, strange = report("verify-certificate", mine)
    assert (code, strange["ok"], strange["stated"]) == (1, False, [])
    assert strange["faults"] == ["it is about other parts than the run's: box, lid"]
    assert report("verify-certificate", mine / "certificate.json")[1]["ok"]


def test_a_certificate_of_a_plan_that_has_changed_since_is_refuted(chest: Path, tmp_path: Path, report: Any) -> None:
    out = tmp_path / "out"
    assert report("build", chest, "--out", out)[0] == 0
    assert report("certify", out, "--budget", "60")[0] == 0
    plan = json.loads((out / "plan.json").read_text())
    plan["joints"][0]["angle_deg"][0] = -60
    (out / "plan.json").write_text(json.dumps(plan))
    code, stale = report("verify-certificate", out)
    assert (code, [fault.partition(":")[0] for fault in stale["faults"]]) == (1, ["it is about other joints than the run's"])


def test_check_needs_no_script(chest: Path, report: Any) -> None:
    for script in (chest / "parts").iterdir():
        script.unlink()
    code, checked = report("check", chest)
    assert (code, checked["schema"], checked["ok"]) == (0, "articad.findings/1", True)


def test_check_of_a_wrong_plan_ends_with_1_and_all_findings(chest: Path, report: Any) -> None:
    wrong = PLAN | {"freedoms": 2, "joints": [PLAN["joints"][0] | {"angle_deg": [0, -100]}]}
    (chest / "plan.json").write_text(json.dumps(wrong))
    code, checked = report("check", chest)
    assert code == 1
    assert {"E_LIMITS_ORDER", "E_DOF_MISMATCH"} <= {finding["code"] for finding in checked["findings"]}


def test_check_of_a_plan_of_the_wrong_form_ends_with_1_too(chest: Path, report: Any) -> None:
    (chest / "plan.json").write_text(json.dumps(PLAN | {"freedom": 1, "ground": 7}))
    code, checked = report("check", chest)
    assert (code, checked["schema"]) == (1, "articad.findings/1")
    assert {finding["code"] for finding in checked["findings"]} == {"E_SCHEMA"}
    assert len(checked["findings"]) == 2


def test_check_of_a_run_holds_its_geometry_too(chest: Path, tmp_path: Path, report: Any) -> None:
    assert report("build", chest, "--out", tmp_path / "out")[0] == 0
    code, checked = report("check", tmp_path / "out")
    assert (code, checked["schema"], checked["ok"]) == (0, "articad.checks/1", True)


def test_check_of_joints_names_the_surfaces_that_make_them(chest: Path, report: Any) -> None:
    code, checked = report("check", chest, "--joints")
    assert (code, checked["ok"], checked["joints"]["schema"]) == (0, True, "articad.realisation/1")
    assert [row["joint"] for row in checked["joints"]["rows"]] == [joint["name"] for joint in PLAN["joints"]]


def test_check_of_the_motion_names_pair_pose_and_depth_whatever_it_is_given(chest: Path, tmp_path: Path, report: Any) -> None:
    """The lid is let too far back: it meets the box behind the hinge."""
    code, checked = report("check", chest, "--motion")
    assert (code, checked["schema"], checked["ok"]) == (0, "articad.checks/1", True)
    assert {"sampled"} == {pair["strength"]["kind"] for pair in checked["pairs"]}
    wrong = PLAN | {"joints": [PLAN["joints"][0] | {"angle_deg": [0, 260]}, *PLAN["joints"][1:]]}
    (chest / "plan.json").write_text(json.dumps(wrong))
    assert report("build", chest, "--out", tmp_path / "out")[0] == 0
    for target in (chest, chest / "plan.json", tmp_path / "out"):
        code, checked = report("check", target, "--motion")
        assert (code, checked["ok"]) == (1, False)
        collisions = [finding for finding in checked["findings"] if finding["code"] == "E_MOTION_COLLISION"]
        assert collisions
        for finding in collisions:
            assert len(finding["parts"]) == 2
            assert finding["pose"]
            assert finding["value"] > 0


def test_export_writes_beside_or_elsewhere_the_same_bytes(chest: Path, tmp_path: Path, report: Any) -> None:
    out = tmp_path / "out"
    assert report("build", chest, "--out", out, "--export", "urdf")[0] == 0
    assert not (out / "export" / "mjcf").exists()
    assert report("export", out, "--to", "mjcf")[0] == 0
    code, exported = report("export", out, "--to", "mjcf,urdf", "--out", tmp_path / "elsewhere")
    assert code == 0
    assert (out / "export" / "mjcf" / "chest.xml").read_bytes() == (tmp_path / "elsewhere" / "mjcf" / "chest.xml").read_bytes()
    assert Path(exported["exports"]["urdf"]["main"]).is_file()
    for option in ("--split", "--trees", "--drawings", "--process=sla"):  # none of the formats has them
        code, refused = report("export", out, "--to", "mjcf,urdf", option, "--out", tmp_path / "refused")
        assert code == 3
        assert f"mjcf, urdf have no option {option.strip('-').partition('=')[0]}" in refused["error"]["message"]
    assert not (tmp_path / "refused").exists()


def test_convert_writes_the_file_that_was_named(chest: Path, tmp_path: Path, report: Any) -> None:
    assert report("build", chest, "--out", tmp_path / "out", "--export", "urdf")[0] == 0
    target = tmp_path / "mujoco" / "model.xml"
    code, converted = report("convert", tmp_path / "out" / "export" / "urdf" / "chest.urdf", target)
    assert (code, converted["schema"], converted["main"]) == (0, "articad.losses/1", str(target))
    mujoco = pytest.importorskip("mujoco")
    assert mujoco.MjModel.from_xml_path(str(target)).njnt == 1


def test_an_ending_that_is_not_a_format_is_an_error_that_lists_them(chest: Path, tmp_path: Path, report: Any) -> None:
    code, failed = report("convert", chest / "plan.json", tmp_path / "x.dwg")
    assert code == 3
    assert ".urdf" in failed["error"]["message"]


@pytest.mark.parametrize("command", [["export", "--to", "urdf"], ["replay"]], ids=lambda words: words[0])
def test_what_is_not_a_run_is_an_error(command: list[str], tmp_path: Path, report: Any) -> None:
    code, failed = report(*command, tmp_path)
    assert code == 3
    assert "is not a run" in failed["error"]["message"]


def test_a_build_is_no_recording(chest: Path, tmp_path: Path, report: Any) -> None:
    assert report("build", chest, "--out", tmp_path / "out")[0] == 0
    code, failed = report("replay", tmp_path / "out")
    assert code == 3
    assert "nothing to replay" in failed["error"]["message"]


def test_a_missing_key_is_named(tmp_path: Path, report: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GEMINI_API_KEY", raising=False)
    code, failed = report("generate", "a lamp", "--model", "gemini/gemini-3-flash", "--out", tmp_path / "out")
    assert code == 3
    assert failed["findings"][0]["code"] == "E_KEY_MISSING"
    assert "GEMINI_API_KEY" in failed["findings"][0]["message"] + failed["findings"][0]["hint"]
    assert not (tmp_path / "out").exists()


BLIND = ("--no-look", "--no-inspection")


@pytest.fixture
def generated(tmp_path: Path, report: Any, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run that a scripted model made."""
    monkeypatch.setattr("articad.agents.live.LiteLLM", lambda *_, **__: stories.flap())
    code, made = report(
        "generate", stories.FLAP_PROMPT, "--model", "scripted", "--max-calls", "10", "--out", tmp_path / "generated", *BLIND
    )
    assert (code, made["ok"]) == (0, True)
    assert made["model"]["calls"] == 4
    return tmp_path / "generated"


def test_generate_leaves_a_run_like_build_s_and_its_recording(generated: Path) -> None:
    run = Run.view(generated)
    assert set(run.exports()) == {"urdf", "mjcf"}
    assert run.replies() == ("design/1", "part/flap/1", "part/plate/1", "requirements")


def test_replay_makes_it_again_without_a_model(generated: Path, tmp_path: Path, report: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object, **__: object) -> None:
        raise AssertionError("a replay asks no model")

    monkeypatch.setattr("articad.agents.live.LiteLLM", forbidden)
    code, replayed = report("replay", generated, "--out", tmp_path / "again", "--strict")
    assert (code, replayed["ok"], replayed["differences"]) == (0, True, [])


def test_a_replay_that_differs_says_where_and_ends_with_1(generated: Path, tmp_path: Path, report: Any) -> None:
    checks = generated / "checks.json"
    checks.write_text(checks.read_text() + "\n")
    code, replayed = report("replay", generated, "--out", tmp_path / "again")
    assert (code, replayed["differences"]) == (1, ["checks.json"])


def test_a_spent_budget_stops_the_run_and_the_same_command_goes_on(tmp_path: Path, report: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.agents.live.LiteLLM", lambda *_, **__: stories.flap())
    command = ["generate", stories.FLAP_PROMPT, "--model", "scripted", "--out", tmp_path / "out", *BLIND, "--max-calls"]
    code, stopped = report(*command, 2)
    assert code == 3
    assert stopped["findings"][0]["code"] == "E_BUDGET"
    code, finished = report(*command, 2)
    assert code == 0
    assert finished["model"]["calls"] == 2


def test_ctrl_c_ends_a_build_at_once_though_a_script_never_ends(chest: Path, tmp_path: Path) -> None:
    (chest / "parts" / "lid.py").write_text("def build(part):\n    while True:\n        pass\n")
    (chest / "parts" / "box.py").write_text(f"{BOX}# not in the cache yet\n")
    command = [sys.executable, "-m", "articad.cli", "build", str(chest), "--out", str(tmp_path / "out")]
    building = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert building.stderr is not None
    assert "box: built" in building.stderr.readline()  # so the other script is at work
    building.send_signal(signal.SIGINT)
    started = time.monotonic()
    _, told = building.communicate(timeout=60)
    assert building.returncode == 130
    assert time.monotonic() - started < 20  # it is 1 s on an idle machine; the script itself would be given 60
    assert "interrupted" in told
    assert "Traceback" not in told


def test_export_takes_collision_servos_and_a_ros_package(chest: Path, tmp_path: Path, report: Any) -> None:
    run, out = tmp_path / "run", tmp_path / "out"
    assert report("build", chest, "--out", run)[0] == 0
    code, _ = report(
        "export", run, "--to", "urdf,mjcf", "--out", out, "--collision", "hull", "--actuators", "position", "--ros", "chest_description"
    )

    assert code == 0
    assert "package://chest_description/meshes/" in (out / "urdf/urdf/chest.urdf").read_text()
    assert "<ros2_control" in (out / "urdf/urdf/chest.urdf").read_text()
    assert list((out / "urdf").rglob("*.srdf"))
    assert "<position" in (out / "mjcf/chest.xml").read_text()


def test_a_print_pack_is_held_to_the_process_it_is_meant_for(tmp_path: Path, report: Any) -> None:
    folder = examples.folder("four_bar")
    plan = json.loads((folder / "plan.json").read_text())
    for joint in plan["joints"]:
        joint.pop("fit", None)
    next(joint for joint in plan["joints"] if joint["type"] == "revolute")["fit"] = {"gap_mm": [0.15, 0.3]}
    for material in plan["materials"]:
        material["density_kg_m3"] = 1240
    (tmp_path / "plan").mkdir()
    (tmp_path / "plan/plan.json").write_text(json.dumps(plan))
    shutil.copytree(folder / "parts", tmp_path / "plan/parts")
    run = tmp_path / "run"
    report("build", tmp_path / "plan", "--out", run)
    for process, codes in (("fdm", ["W_PRINT_CLEARANCE"]), ("sla", [])):
        _, told = report("export", run, "--to", "3mf", "--process", process, "--out", tmp_path / process)
        assert [finding["code"] for finding in told["exports"]["3mf"]["findings"]] == codes
        assert len(list((tmp_path / process / "3mf").glob("*.3mf"))) == len(plan["parts"])


@pytest.mark.parametrize(("flags", "asked"), [([], True), (["--json"], False), (["-q"], False)])
def test_at_a_terminal_somebody_is_asked_which_idea_to_make(flags: list[str], asked: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    assert models._is_asked(cli._parsed(["generate", "a toy for two", *flags])) is asked


def test_the_parts_list_weighs_what_the_run_weighs(chest: Path, tmp_path: Path, report: Any) -> None:
    _, built = report("build", chest, "--out", tmp_path / "run", "--no-pictures", "--export", "plan")
    before = Run.view(tmp_path / "run").hashes()
    code, bill = report("bom", tmp_path / "run", "--purchased", "lid", "--out", tmp_path / "papers")
    assert (code, bill["schema"], [row["supply"] for row in bill["items"]]) == (0, "articad.bom/1", ["made", "purchased"])
    assert bill["mass_kg"] == pytest.approx(built["assembly"]["mass_kg"], rel=1e-12)
    assert sum(row["total_kg"] for row in bill["items"]) == pytest.approx(built["assembly"]["mass_kg"], rel=1e-12)
    assert json.loads((tmp_path / "papers" / "chest_bom.json").read_text())["items"] == bill["items"]
    assert Run.view(tmp_path / "run").hashes() == before


def test_no_drawing_of_a_part_has_the_file_of_the_assembly_or_of_a_page_of_the_manual(chest: Path, tmp_path: Path, report: Any) -> None:
    plan = (chest / "plan.json").read_text()
    for old, new in (("box", "assembly"), ("lid", "manual_01")):
        plan = re.sub(rf"\b{old}\b", new, plan)
        (chest / "parts" / f"{old}.py").rename(chest / "parts" / f"{new}.py")
    (chest / "plan.json").write_text(plan)
    out = tmp_path / "papers"
    files = [
        Path(file).name
        for line in (("drawing",), ("manual", "--to", "svg"))
        for file in report(line[0], chest, *line[1:], "--out", out)[1]["files"]
    ]
    assert len(set(files)) == len(files) == len([*out.iterdir()])
    assert {"chest_assembly.svg", "chest_assembly_2.svg", "chest_manual_01.svg", "chest_manual_01_2.svg"} <= set(files)
    assert Path(report("drawing", chest, "assembly", "--out", out)[1]["files"][0]).name == "chest_assembly_2.svg"


def test_drawings_are_written_beside_the_run_and_say_what_they_show(chest: Path, tmp_path: Path, report: Any) -> None:
    report("build", chest, "--out", tmp_path / "run", "--no-pictures", "--export", "plan")
    before = Run.view(tmp_path / "run").hashes()
    code, drawn = report("drawing", tmp_path / "run", "--out", tmp_path / "papers")
    assert (code, drawn["schema"], len(drawn["sheets"])) == (0, "articad.drawings/1", 3)
    assert {Path(file).name for file in drawn["files"]} == {
        f"chest_{name}.{kind}" for name in ("assembly", "box", "lid") for kind in ("svg", "dxf")
    }
    assert all(Path(file).stat().st_size > 1000 for file in drawn["files"])
    assert {"text": "60", "value": 60.0, "name": "width", "view": "front"} in drawn["sheets"][1]["dimensions"]
    assert Run.view(tmp_path / "run").hashes() == before
    assert report("drawing", tmp_path / "run", "bix", "--out", tmp_path / "papers")[0] == 3
