"""The cheap half of a simulation, which every build does: load, hold at rest, let go."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from lxml import etree

from articad import cli
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.runs.record import record_objections, run_report
from articad.runs.run import Run
from articad.simulation.standing import stands
from articad.simulation.trial import try_out
from articad.simulation.verdict import SimulationVerdict
from tests.assemblies import four_bar
from tests.simulate.slow import take
from tests.test_commands import write_chest

pytestmark = pytest.mark.engines


def test_a_loop_stands_as_mjcf_and_open_as_urdf(tmp_path: Path) -> None:
    assembly = four_bar()
    for write in (write_mjcf, write_urdf):
        bundle = write(assembly)
        bundle.write(tmp_path)
        assert not stands(assembly, tmp_path / bundle.main)


def test_a_loop_that_is_open_at_rest_and_a_file_that_does_not_load_are_errors(tmp_path: Path) -> None:
    assembly = four_bar()
    bundle = write_mjcf(assembly)
    bundle.write(tmp_path)
    path = tmp_path / bundle.main
    root = etree.fromstring(path.read_bytes())
    for site in root.iterfind(".//site"):  # 20 mm aside in the plane of the loop
        if site.get("name", "").endswith("__far"):
            x, y, z = map(float, site.get("pos").split())
            site.set("pos", f"{x + 0.02} {y} {z}")
    path.write_bytes(etree.tostring(root))

    assert set(stands(assembly, path).codes) & {"E_SIM_RESIDUAL", "E_SIM_UNSETTLED"}

    path.write_bytes(b"<mujoco><worldbody><body><joint/></body></worldbody></mujoco>")
    assert stands(assembly, path).codes == ("E_SIM_LOAD",)


def test_what_does_not_finish_in_time_is_not_tried_which_is_told_and_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    take(monkeypatch, "articad.simulation.trial", 30.0)
    assembly = four_bar()
    bundle = write_mjcf(assembly)
    bundle.write(tmp_path)

    (finding,) = findings = stands(assembly, tmp_path / bundle.main, seconds=20.0)

    assert finding.code == "W_SIM_NOT_TRIED"
    assert "20 s" in finding.message
    assert findings.ok
    late = try_out("mujoco", tmp_path / bundle.main, seconds=20.0)
    assert late.loads is None
    assert not SimulationVerdict("", (late,)).ok  # nothing was tried


def test_a_build_that_could_not_be_tried_is_ok_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    take(monkeypatch, "articad.simulation.trial", math.inf)
    out = tmp_path / "out"
    assert cli.main(["build", str(write_chest(tmp_path / "chest")), "--out", str(out), "--no-pictures", "-q"]) == 0

    report = json.loads((out / "export/mjcf/losses.json").read_text())
    assert "W_SIM_NOT_TRIED" in {finding["code"] for finding in report["findings"]}
    assert report["ok"]
    assert run_report(Run.view(out))["ok"]
    assert any("not tried in MuJoCo" in str(event.get("message")) for event in Run.view(out).events())


def test_every_build_asks_and_an_objection_makes_the_run_not_ok(tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert cli.main(["build", str(write_chest(tmp_path / "chest")), "--out", str(out), "--no-pictures", "-q"]) == 0
    run = Run.view(out)
    asked = {event["where"]: event["ok"] for event in run.events() if event.get("message") == "loaded and held at rest in MuJoCo"}
    assert asked == {"export.urdf": True, "export.mjcf": True}
    assert run_report(run)["ok"]

    broken = tmp_path / "broken.xml"
    broken.write_text("<mujoco/")
    (finding,) = findings = stands(four_bar(), broken)
    before = json.loads((out / "export/mjcf/losses.json").read_text())
    with Run.open(out) as again:
        record_objections(again, "mjcf", findings)

    after = json.loads((out / "export/mjcf/losses.json").read_text())
    assert after["findings"] == [*before["findings"], finding.to_json()]
    assert {**after, "ok": True, "findings": []} == {**before, "findings": []}
    assert not run_report(run)["ok"]
