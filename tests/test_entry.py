"""The public verbs take an assembly, a file, a plan folder or a run folder."""

from __future__ import annotations

from pathlib import Path

import pytest

import articad as ac
from articad import examples
from articad.cli import main
from articad.errors import ReadError
from tests.assemblies import geared_pair


def test_a_plan_its_folder_its_run_and_its_exports_are_read_as_the_same_parts(tmp_path: Path) -> None:
    folder = examples.folder("slider_crank")
    assert main(["build", str(folder), "--out", str(tmp_path / "run"), "--no-pictures", "--export", "urdf,mjcf", "-q"]) == 0
    made = ac.read(folder)
    sources = [
        folder / "plan.json",
        tmp_path / "run",
        *(tmp_path / "run" / "export").glob("*/*.urdf"),
        *(tmp_path / "run").glob("export/*/*.xml"),
    ]
    assert len(sources) == 4
    for source in sources:
        assert list(ac.read(source).parts) == list(made.parts), source


def test_an_assembly_and_the_file_of_it_are_audited_certified_and_simulated(tmp_path: Path) -> None:
    assembly = geared_pair()
    ac.write(assembly, tmp_path / "pair.urdf")
    quick = ac.AuditOptions(engines=False, motion=False)
    for target in (assembly, tmp_path / "pair.urdf"):
        assert isinstance(ac.audit(target, quick).findings, ac.Findings)
        assert ac.certify(target, budget=5.0).ok == assembly.certify(budget=5.0).ok
        assert ac.simulate(target, engines=("mujoco",)).outcomes[0].loads


@pytest.mark.parametrize("verb", [ac.read, ac.audit, ac.certify, ac.simulate])
def test_what_is_not_there_is_refused_by_name(verb: object, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"nowhere\.urdf"):
        verb(tmp_path / "nowhere.urdf")  # type: ignore[operator]
