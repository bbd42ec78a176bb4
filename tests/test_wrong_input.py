"""A tour of wrong input, through the command line: documented exit codes, every finding at once, earlier results kept, advice that works.

Each stop of the tour gives something wrong, looks at what is said, and then does literally what the advice says.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from articad import cli
from articad.kernels.choice import kernel_named
from tests.agents import stories
from tests.test_commands import PLAN, write_chest

FINDINGS, USAGE, CANNOT_GO_ON, INTERRUPTED = 1, 2, 3, 130
QUICK = ("--no-pictures", "--verify", "rest")
Plan = dict[str, Any]
Say = Callable[..., tuple[int, str]]


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("GEMINI_API_KEY", "")
        patch.setattr("articad.kernels.choice.kernel_named", shared_kernel)
        yield


def shared_kernel(name: str, **options: Any) -> Any:
    """Return a kernel that all tests share: its start takes seconds."""
    return stories.kernel() if name == "build123d" else kernel_named(name, **options)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory, cache: None) -> Path:
    """A folder with the chest and a run of it; copied by whoever changes it."""
    folder = tmp_path_factory.mktemp("built")
    write_chest(folder / "chest")
    assert cli.main(["build", str(folder / "chest"), "--out", str(folder / "run"), *QUICK, "-q"]) == 0
    return folder


@pytest.fixture
def work(built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of it, as the working folder."""
    shutil.copytree(built, tmp_path / "work")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path / "work"


@pytest.fixture
def say(capsys: pytest.CaptureFixture[str]) -> Say:
    """Run a command line and return its exit code and all that it said."""

    def run(*words: str) -> tuple[int, str]:
        try:
            code = cli.main(list(words))
        except SystemExit as end:  # argparse
            code = int(end.code or 0)
        captured = capsys.readouterr()
        return code, captured.out + captured.err

    return run


def edited(folder: Path, change: Callable[[Plan], None]) -> None:
    file = folder / "plan.json"
    plan = json.loads(file.read_text())
    change(plan)
    file.write_text(json.dumps(plan))


def contents(folder: Path) -> dict[str, str]:
    """The digest of every file, by its place."""
    return {
        file.relative_to(folder).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.rglob("*") if file.is_file()
    }


def commanded(text: str) -> list[str]:
    """The words of the command that a text shows between backticks."""
    return str(re.findall(r"`articad ([^`]+)`", text)[0]).split()


def misspelt(plan: Plan) -> None:
    plan["joints"][0]["angle_dg"] = plan["joints"][0].pop("angle_deg")


# ---------------------------------------------------------------------- plans


def test_a_misspelt_field_is_named_with_the_one_that_was_meant(work: Path, say: Say) -> None:
    edited(work / "chest", misspelt)
    code, said = say("check", "chest")
    assert code == FINDINGS
    wrong, meant = re.search(r"no field '(\w+)' here.\n.*Did you mean '(\w+)'", said).groups()  # type: ignore[union-attr]
    assert say("build", "chest", "--out", "new", *QUICK)[0] == CANNOT_GO_ON
    assert not (work / "new").exists()
    edited(work / "chest", lambda plan: plan["joints"][0].update({meant: plan["joints"][0].pop(wrong)}))
    assert say("check", "chest")[0] == 0


def test_every_mistake_is_found_at_once_whatever_stage_would_see_it(work: Path, say: Say) -> None:
    def change(plan: Plan) -> None:
        plan["color"] = "red"  # no such field
        plan["parts"][0]["densty"] = 3  # nor this
        plan["parts"][1]["material"] = "oaken"  # not declared
        plan["parts"][1]["connectors"][0]["z"] = [0, 0, 0]  # no direction
        plan["parts"][0]["envelope_mm"] = ["widht", 40, 20]  # no such parameter
        plan["parameters"][0]["value"] = 1000  # beyond its bound
        plan["joints"][0]["parent"] = "box.class"  # no name
        plan["joints"][0]["angle_deg"] = [0, -100]  # reversed
        plan["materials"][0]["density_kg_m3"] = -700  # not positive

    edited(work / "chest", change)
    expected = [
        *("color", "parts.box.densty", "parts.lid.material", "parts.lid.connectors.hinge.z", "parts.box.envelope_mm[0]"),
        *("parameters.width", "joints.hinge.parent", "joints.hinge.angle_deg", "materials.oak.density_kg_m3"),
    ]
    for command, code in ((("check", "chest"), FINDINGS), (("build", "chest", "--out", "new"), CANNOT_GO_ON)):
        found, said = say(*command)
        assert found == code
        assert [where for where in expected if f" {where}:" not in said] == []
    assert "no_name" not in said  # what stands in for a name is not said to be one
    assert not (work / "new").exists()


@pytest.mark.parametrize("seed", range(12))
def test_any_mistakes_together_are_each_named(seed: int, work: Path, say: Say) -> None:
    import random

    mistakes: dict[str, Callable[[Plan], Any]] = {
        "parts.box.role_": lambda plan: plan["parts"][0].update(role_="x"),
        "joints.hinge.driver": lambda plan: plan["joints"][0].update(driver="maybe"),
        "freedoms": lambda plan: plan.update(freedoms=4),
        "materials.oak.color": lambda plan: plan["materials"][0].update(color="brownish"),
        "parts.lid.connectors.hinge.x": lambda plan: plan["parts"][1]["connectors"][0].update(x=[2, 0, 0]),
        "joints.hinge.child": lambda plan: plan["joints"][0].update(child="lid.hinges"),
        "parameters.width": lambda plan: plan["parameters"][0].update(value=39),
        "joints.hinge.effort_n": lambda plan: plan["joints"][0].update(effort_n=3),
        "ground": lambda plan: plan.update(ground="bax"),
    }
    chosen = random.Random(seed).sample(sorted(mistakes), 4)
    for where in chosen:
        edited(work / "chest", mistakes[where])
    code, said = say("check", "chest")
    structural = {"freedoms", "joints.hinge.child", "ground"}  # what is not connected, or whose joints are in doubt, has no known freedoms
    named = [where for where in chosen if re.search(rf" {re.escape(where)}[:\[.]| {re.escape(where.rpartition('.')[0])}:", said)]
    assert code == FINDINGS
    assert set(chosen) - structural <= set(named)


def test_every_key_that_is_there_twice_is_named_with_all_else(work: Path, say: Say) -> None:
    file = work / "chest" / "plan.json"
    plan = file.read_text()
    misspelt_plan = plan.replace('"angle_deg"', '"angle_dg"', 1)
    file.write_text(misspelt_plan.replace("{", '{"name": "other", "ground": "box", ', 1))
    code, said = say("check", "chest")

    assert code == FINDINGS
    assert all(words in said for words in ("'name' occurs twice", "'ground' occurs twice", "angle_dg"))


def test_a_plan_without_parts_is_told_to_declare_one(work: Path, say: Say) -> None:
    edited(work / "chest", lambda plan: plan.update(parts=[], joints=[]))
    code, said = say("check", "chest")

    assert code == FINDINGS
    assert "there are no parts" in said
    assert "[]" not in said


def test_radians_are_suspected_and_the_degrees_offered_are_right(work: Path, say: Say) -> None:
    edited(work / "chest", lambda plan: plan["joints"][0].update(angle_deg=[-1.745, 0]))
    code, said = say("check", "chest")
    assert (code, "W_LIMITS_UNITS" in said) == (0, True)
    offered = json.loads(re.search(r"give (\[.*?\])", said)[1])  # type: ignore[index]
    edited(work / "chest", lambda plan: plan["joints"][0].update(angle_deg=offered))
    code, said = say("check", "chest")
    assert (code, "W_LIMITS_UNITS" in said) == (0, False)


def test_a_plan_in_metres_is_refused_before_anything_is_built(work: Path, say: Say) -> None:
    def metres(plan: Plan) -> None:
        plan["parameters"][0] = {"name": "width", "value": 0.06}
        for part in plan["parts"]:
            part["envelope_mm"] = [0.06, 0.04, 0.02]
            for connector in part["connectors"]:
                connector["o"] = [value / 1000 for value in connector["o"]]
        plan["parts"][1]["rest_pose"]["at"] = [0, 0.02, 0.0002]

    edited(work / "chest", metres)
    code, said = say("build", "chest", "--out", "new")
    assert (code, "E_SCALE" in said, "metres" in said, (work / "new").exists()) == (CANNOT_GO_ON, True, True, False), said
    assert say("check", "chest")[0] == FINDINGS


@pytest.mark.parametrize("text", ["", "hello", "[1]", '{"schema": 1, "schema": 2}', '{"name": NaN}', '{"name": "a",}', "{" * 5000])
def test_what_is_no_json_object_is_said_to_be_none(text: str, work: Path, say: Say) -> None:
    (work / "chest/plan.json").write_text(text)
    code, said = say("check", "chest")
    assert (code, "error" in said) == (FINDINGS, True)
    code, said = say("build", "chest", "--out", "new")
    assert (code, (work / "new").exists()) == (CANNOT_GO_ON, False)
    assert "defect" not in said


NOT_THERE = """
check X
build X
show X
watch X --no-browser
sim X
audit X
certify X
export X --to urdf
edit X longer
resume X
replay X
verify-certificate X.json
order X
manual X
drawing X
bom X
render X
part X lid
pull X X.FCStd
convert X out.urdf
adopt X --out out
batch X
bench score X
bench table X
bench judge X
memory import X
"""


@pytest.mark.parametrize("name", ["nothing", "nothing.urdf", "nothing.igs"])
@pytest.mark.parametrize("line", NOT_THERE.strip().split("\n"))
def test_what_is_not_there_cannot_be_gone_on_with(line: str, name: str, work: Path, say: Say) -> None:
    code, said = say(*line.replace("X", name).split())
    assert code == CANNOT_GO_ON
    assert name in said
    assert "KEY" not in said  # no key is asked for before it is known what for
    assert "extension" not in said  # what is not there has none
    assert "at the named place" not in said  # nor a place in it


def test_empty_folders_and_folders_in_the_place_of_files(work: Path, say: Say) -> None:
    (work / "empty").mkdir()
    for command in ("audit", "check", "build"):
        assert say(command, "empty")[0] == CANNOT_GO_ON
    code, said = say("convert", "chest", "out.urdf")
    assert code == CANNOT_GO_ON
    named = re.search(r"Name the file: (.*)\.\n", said)[1]  # type: ignore[index]
    assert say("convert", named, "out.urdf", "-q")[0] == 0
    assert (work / "out.urdf").is_file()


# ---------------------------------------------------------------------- scripts and parameters


def test_a_missing_and_a_broken_script_are_named(work: Path, say: Say) -> None:
    script = (work / "chest/parts/lid.py").read_text()
    (work / "chest/parts/lid.py").unlink()
    code, said = say("build", "chest", "--out", "new", *QUICK)
    assert (code, "E_SCRIPT_MISSING parts.lid" in said, "built" in said) == (CANNOT_GO_ON, True, False)
    (work / "chest/parts/lid.py").write_text("def build(part:\n")
    code, said = say("build", "chest", "--out", "new", *QUICK)
    assert (code, "E_SCRIPT_ERROR parts.lid" in said, "line 1" in said) == (CANNOT_GO_ON, True, True)
    (work / "chest/parts/lid.py").write_text(script)
    assert say("build", "chest", "--out", "new", *QUICK)[0] == 0


def test_a_misspelt_parameter_and_one_out_of_range(work: Path, say: Say) -> None:
    code, said = say("build", "chest", "--out", "new", "--set", "widht=70", *QUICK)
    meant = re.search(r"Did you mean '(\w+)'", said)[1]  # type: ignore[index]
    assert code == CANNOT_GO_ON
    code, said = say("build", "chest", "--out", "new", "--set", f"{meant}=900", *QUICK)
    bound = re.search(r"Set the value to (\d+)", said)[1]  # type: ignore[index]
    assert (code, (work / "new").exists()) == (CANNOT_GO_ON, False)
    assert say("build", "chest", "--out", "new", "--set", f"{meant}=wide")[0] == USAGE
    assert say("build", "chest", "--out", "new", "--set", f"{meant}={bound}", *QUICK)[0] == 0


# ---------------------------------------------------------------------- where results go


def test_other_parameters_into_an_old_run_are_refused_before_anything_is_built(work: Path, say: Say) -> None:
    before = contents(work / "run")
    code, said = say("build", "chest", "--out", "run", "--set", "width=70", *QUICK)
    assert (code, "parameters" in said, " built" in said) == (CANNOT_GO_ON, True, False)
    assert contents(work / "run") == before
    assert "Name another directory with --out" in said
    assert "without --set" in said
    assert say("build", "chest", "--out", "other", "--set", "width=70", *QUICK)[0] == 0
    assert say("build", "chest", "--out", "run", *QUICK)[0] == 0
    code, said = say("build", "chest", "--out", "other", *QUICK)
    assert code == CANNOT_GO_ON
    flags = re.search(r"with (--set \S+=\d+)", said)[1].split()  # type: ignore[index]
    assert say("build", "chest", "--out", "other", *flags, *QUICK)[0] == 0


def test_folders_that_hold_something_files_and_places_that_cannot_be_written(work: Path, say: Say) -> None:
    (work / "mine").mkdir()
    (work / "mine/letter.txt").write_text("keep me")
    (work / "file").write_text("keep me")
    for place in ("mine", "file", "/proc/run"):
        before = contents(work)
        code, said = say("build", "chest", "--out", place, *QUICK)
        assert (code, " built" in said, contents(work) == before) == (CANNOT_GO_ON, False, True), place
        assert place in said
    (work / "mine/letter.txt").unlink()  # "or empty this one"
    assert say("build", "chest", "--out", "mine", *QUICK)[0] == 0


def test_a_disk_that_fills_up_keeps_what_was_finished(work: Path, say: Say) -> None:
    def small() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))  # the disk is full after so many bytes of a file

    before = contents(work / "run")
    words = [sys.executable, "-m", "articad.cli", "build", "chest", "--out", "new", "--force", *QUICK]
    ended = subprocess.run(words, preexec_fn=small, capture_output=True, text=True, timeout=300, check=False)
    assert ended.returncode == CANNOT_GO_ON, ended.stderr
    assert "Traceback" not in ended.stderr
    assert contents(work / "run") == before
    assert say("build", "chest", "--out", "new", *QUICK)[0] == 0  # the same command again, with room


def test_interrupted_work_ends_with_130_and_the_same_command_goes_on(work: Path, say: Say) -> None:
    slow = (work / "chest/parts/lid.py").read_text().replace("def build(part):", "import time\ndef build(part):\n    time.sleep(3)")
    (work / "chest/parts/lid.py").write_text(slow)
    words = [sys.executable, "-m", "articad.cli", "build", "chest", "--out", "new", *QUICK]
    building = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=os.environ.copy())
    until = time.monotonic() + 60
    while not (work / "new" / "request.json").exists() and time.monotonic() < until:
        time.sleep(0.05)
    building.send_signal(signal.SIGINT)
    said, _ = building.communicate(timeout=60)
    assert (building.returncode, "Traceback" in said) == (INTERRUPTED, False)
    assert say("build", "chest", "--out", "new", *QUICK)[0] == 0


def test_a_build_is_not_resumed_but_built_again(work: Path, say: Say) -> None:
    code, said = say("resume", "run")
    assert (code, "KEY" in said) == (CANNOT_GO_ON, False)
    words = re.search(r"articad (build PLAN_DIR --out run)", said)[1].replace("PLAN_DIR", "chest").split()  # type: ignore[index]
    assert say(*words, *QUICK)[0] == 0


def test_a_plan_in_the_place_of_a_run_is_told_how_to_become_one(work: Path, say: Say) -> None:
    code, said = say("certify", "chest")
    assert code == CANNOT_GO_ON
    words = [word.replace("RUN", "new") for word in commanded(said)]
    assert say(*words, *QUICK)[0] == 0
    assert say("certify", "new")[0] == 0


# ---------------------------------------------------------------------- files of others


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.urdf", ""),
        ("a.urdf", "hello"),
        ("a.urdf", "<mujoco/>"),
        ("a.xml", "<robot name='a'/>"),
        ("a.xml", "<mujoco><worldbody><body><joint type='ball' range='x'/></body></worldbody></mujoco>"),
        ("a.step", "hello"),
        ("a.FCStd", "hello"),
        ("a.json", "hello"),
        ("a.foo", "hello"),
        ("a", "hello"),
    ],
)
def test_files_that_are_not_what_their_names_say(name: str, text: str, work: Path, say: Say) -> None:
    (work / name).write_text(text)
    for target in ("out.urdf", "out.xml"):
        code, said = say("convert", name, target)
        assert (code, "defect" in said, (work / target).exists()) == (CANNOT_GO_ON, False, False)
        assert name in said or name == "a.json"  # of a plan the place in its text is named


def test_mistakes_of_a_urdf_are_all_named_at_once(work: Path, say: Say) -> None:
    (work / "a.urdf").write_text(
        '<robot name="i"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="1" upper="-1" effort="-5" velocity="1"/></joint>'
        '<joint name="k" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="1"/>'
        '<mimic joint="nosuch"/></joint></robot>'
    )
    code, said = say("convert", "a.urdf", "out.xml")
    assert (code, [word for word in ("reversed", "effort -5", "nosuch") if word not in said]) == (0, [])
    code, said = say("audit", "a.urdf", "--no-engines")
    assert code == FINDINGS
    assert {"E_AUDIT_LIMITS_ORDER", "E_AUDIT_MIMIC"} <= set(re.findall(r"[EW]_[A-Z_]+", said))


def test_formats_that_are_not_written_are_refused_with_those_that_are(work: Path, say: Say) -> None:
    code, said = say("convert", "chest/plan.json", "out.dwg")
    assert code == CANNOT_GO_ON
    assert all(suffix in said for suffix in (".urdf", ".xml", ".sdf", ".usda", ".step", ".glb"))


# ---------------------------------------------------------------------- the command line itself


@pytest.mark.parametrize(
    ("words", "meant"),
    [(("biuld", "chest"), "build"), (("build", "chest", "--ot", "new"), "--out"), (("build", "chest", "--kernel", "freecat"), "freecad")],
)
def test_misspelt_words_are_usage_and_the_right_one_is_offered(words: tuple[str, ...], meant: str, work: Path, say: Say) -> None:
    code, said = say(*words)
    assert code == USAGE
    assert f"did you mean {meant!r}" in said


def test_a_part_that_is_not_there(work: Path, say: Say) -> None:
    code, said = say("part", "chest", "lit")
    assert code == CANNOT_GO_ON
    meant = re.search(r"Did you mean '(\w+)'", said)[1]  # type: ignore[index]
    assert say("part", "chest", meant)[0] == 0


def test_the_tour_has_more_than_twenty_stops() -> None:
    stops = [name for name in globals() if name.startswith("test_")]
    assert len(stops) >= 20
    assert PLAN["name"] == "chest"
