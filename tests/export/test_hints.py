"""Hints of writers and of runs, followed literally: what a hint says is done and nothing else; its finding is gone, and no error has come."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.export.mjcf import write_mjcf
from articad.export.threemf import write_3mf
from articad.export.urdf import write_urdf
from articad.findings import Finding, Findings
from articad.kinematics import declare
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.resolve import Fit
from articad.runs.run import Run, RunRequest, open_or_create
from tests.assemblies import block, four_bar, frame, geared_pair, of_density
from tests.export.test_losses import JOINTS, WRITERS, pair
from tests.importers.test_round_trips import _joint
from tests.obedience import assert_heals

CODES = {"E_UNREPRESENTABLE", "W_PRINT_CLEARANCE", "E_MIMIC_FIT", "I_EFFORT_ASSUMED", "E_WRITE", "E_RUN"}


def said(make: Callable[[], Any]) -> Findings:
    """Return the findings of an error, or of what was made."""
    try:
        made = make()
    except ArticadError as error:
        return error.findings
    return Findings(getattr(made, "findings", ()))


def of(found: Findings, code: str, words: str) -> Finding:
    return next(finding for finding in found.of(code) if re.search(words, finding.hint))


@pytest.mark.parametrize("writer", WRITERS)
def test_without_strict_a_joint_becomes_what_the_hint_says(writer: str) -> None:
    for kind, joint in JOINTS.items():
        before = said(partial(WRITERS[writer], pair(joint), strict=True))
        for finding in before.of("E_UNREPRESENTABLE"):
            told = re.search(r"Without strict it becomes (.*)\.$", finding.hint)
            assert told, finding.hint
            bundle = WRITERS[writer](pair(joint))
            assert_heals(finding, before, bundle.findings)
            assert told[1] in [loss.kept for loss in bundle.losses if loss.where == finding.where], kind


def test_a_joint_that_rests_at_zero_is_told_in_a_plan() -> None:
    base, part = block("base", a=frame(), b=frame(at=(30, 0, 0))), block("part", a=frame(), b=frame(at=(30, 0, 0)))

    def plan(rest: float) -> Any:
        planar = replace(_joint(JointType.PLANAR, "p", base["a"], part["a"]), rest=(rest, 0.0, 0.0))
        turn = declare.revolute("r", base["b"], part["b"], limits=(-1, 1))
        return Assembly.from_parts("p", parts=[base, part], joints=[planar, turn], ground="base").to_plan()

    before = said(lambda: plan(30.0))
    finding = of(before, "E_UNREPRESENTABLE", "Let it rest at zero")
    assert_heals(finding, before, said(lambda: plan(0.0)))


@pytest.mark.parametrize(
    ("words", "gap", "process"), [("Widen the gap", 0.5, "fdm"), ("or use another process", 0.15, "sla")], ids=["wider", "process"]
)
def test_a_gap_that_prints(words: str, gap: float, process: Any) -> None:
    def printed(gap: float, process: Any) -> Findings:
        return write_3mf(replace(of_density(geared_pair(), 1240), fits={"a": Fit(gap, 1.0)}), process=process).findings

    before = printed(0.15, "fdm")
    finding = of(before, "W_PRINT_CLEARANCE", words)
    assert_heals(finding, before, printed(gap, process))


def test_the_gap_that_the_message_states_is_wide_enough() -> None:
    def printed(gap: float) -> Findings:
        return write_3mf(replace(of_density(geared_pair(), 1240), fits={"a": Fit(gap, 1.0)})).findings

    (finding,) = printed(0.15)
    needed = re.search(r"needs ([\d.]+) mm", finding.message)
    assert needed
    assert not printed(float(needed[1]))


def test_loops_that_are_no_straight_lines_are_written_in_each_way_of_the_hint() -> None:
    bar = four_bar()
    crank, *others = bar.joints
    crank = replace(crank, limits=replace(crank.limits, lower=(0.6,), upper=(1.4,)))
    bounded = replace(bar, mechanism=Mechanism(bar.mechanism.parts, "base", [crank, *others]))
    before = said(lambda: write_urdf(bounded, loops="mimic"))
    finding = of(before, "E_MIMIC_FIT", "Use loops none, isaac or drake, or MJCF")
    for loops in re.findall(r"none|isaac|drake", finding.hint):
        assert_heals(finding, before, said(partial(write_urdf, bounded, loops=loops)))
    assert_heals(finding, before, said(lambda: write_mjcf(bounded)))


def test_drives_that_are_stated_are_not_assumed() -> None:
    assembly = pair(JOINTS["revolute"])

    def written(joints: Sequence[Joint]) -> Findings:
        return write_urdf(replace(assembly, mechanism=Mechanism(assembly.mechanism.parts, "base", joints))).findings

    before = written(assembly.joints)
    finding = of(before, "I_EFFORT_ASSUMED", "State them where the drives are known")
    stated = [replace(joint, effort=(500.0,), velocity=(2.0,), damping=(1.0,)) for joint in assembly.joints]
    assert_heals(finding, before, written(stated))


# ---------------------------------------------------------------------- runs


def request(prompt: str = "a box") -> RunRequest:
    return RunRequest(prompt=prompt, options={})


def created(out: Path, prompt: str = "a box") -> Findings:
    return said(lambda: open_or_create(request(prompt), out).close())


def a_file(path: Path) -> None:
    path.write_text("not a folder")


def a_stranger(path: Path) -> None:
    path.mkdir()
    (path / "letter.txt").write_text("mine")


def another_run(path: Path) -> None:
    Run.create(request("a lamp"), out=path).close()


@pytest.mark.parametrize("occupy", [a_file, a_stranger, another_run])
def test_a_run_in_another_directory_is_made(occupy: Callable[[Path], None], tmp_path: Path) -> None:
    occupy(tmp_path / "run")
    before = created(tmp_path / "run")
    finding = of(before, "E_RUN", "Name (a new|another) directory with --out")
    assert_heals(finding, before, created(tmp_path / "other"))


def test_an_emptied_directory_holds_a_run(tmp_path: Path) -> None:
    a_stranger(tmp_path / "run")
    before = created(tmp_path / "run")
    finding = of(before, "E_RUN", "or empty this one")
    (tmp_path / "run" / "letter.txt").unlink()
    assert_heals(finding, before, created(tmp_path / "run"))


def test_a_run_that_another_process_uses_is_free_when_it_ends(tmp_path: Path) -> None:
    run = Run.create(request(), out=tmp_path / "run")
    before = created(tmp_path / "run")
    finding = of(before, "E_RUN", "Wait for it to end, or name another directory")
    assert_heals(finding, before, created(tmp_path / "other"))
    run.close()
    assert_heals(finding, before, created(tmp_path / "run"))


def test_the_same_command_goes_on_when_a_disk_takes_files_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = Run.create(request(), out=tmp_path / "run")

    def refuses(_: int) -> None:
        raise OSError(28, os.strerror(28))

    with monkeypatch.context() as patched:
        patched.setattr(os, "fsync", refuses)
        before = said(lambda: run.save_plan("{}", 0))
    finding = of(before, "E_WRITE", "Correct this and give the same command again: finished work is kept")
    assert_heals(finding, before, said(lambda: run.save_plan("{}", 0)))
    run.close()
