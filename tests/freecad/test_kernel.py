"""The FreeCAD kernel: editable trees or a finding that says why not; and the same solids as the other kernel's."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest

import articad as ac
from articad.errors import BuildError, ContractError
from articad.kernels import sandbox
from articad.kernels.build123d import Build123dKernel
from articad.kernels.freecad import FreeCADKernel, tree_findings
from articad.kernels.kernel import BuiltPart
from articad.plan.brief import brief
from articad.plan.resolve import resolve
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PLATE: dict[str, Any] = {
    "name": "plate",
    "description": "",
    "material": "steel",
    "dimensions": {"width": 40.0, "thickness": 5.0, "hole_count": 4},
    "envelope_mm": None,
    "connectors": {},
}
GOOD = """
def build(part):
    part.box((0, 0, 0), ("width", "width", "thickness"))
    hole = part.cylinder(("width / 5", "width / 2", 0), "+Z", 2, "thickness", cut=True)
    part.linear_pattern([hole], "X", "width * 3 / 5", "hole_count")
    return part.body, {}
"""
FROZEN = """
import Part
def build(part):
    solid = part.document.addObject("Part::Feature", "Solid")
    solid.Shape = Part.makeBox(40, 40, 5)
    part.body.BaseFeature = solid
    part.document.recompute()
    return part.body, {}
"""
OFF_TIP = """
def build(part):
    part.box((0, 0, 0), ("width", "width", "thickness"))
    hole = part.cylinder(("width / 5", "width / 2", 0), "+Z", 2, "thickness", cut=True)
    part.linear_pattern([hole], "X", "width * 3 / 5", "hole_count")
    part.body.Tip = hole
    part.document.recompute()
    return part.body, {}
"""
OWN = """
def build(part):
    part.box((0, 0, 0), ("width", "width", "thickness"))
    part.settle()
    block = part.body.Tip
    bevel = part.body.newObject("PartDesign::Chamfer", "Bevel")
    bevel.Base = (block, [])
    bevel.UseAllEdges = True
    bevel.setExpression("Size", "0.1 * " + part.expression("thickness"))
    part.body.Tip = bevel
    part.document.recompute()
    return part.body, {}
"""
SWEPT = """
def build(part):
    outline = part.sketch("YZ", at=(0, 0, 0))
    part.rectangle(outline, "-thickness / 2", "-thickness / 2", "thickness", "thickness")
    way = part.sketch("XY")
    part.path(way, [(0, 0), ("width", 0), ("width", "10 * hole_count"), (0, "10 * hole_count")])
    part.sweep(outline, way)
    return part.body, {}
"""
CYCLE = OWN.replace("(block, [])", "(part.body.Tip, [])")
TOO_LARGE = OWN.replace("0.1 *", "3 *")
UNTIED = GOOD.replace('"thickness"))', "5))").replace('2, "thickness"', "2, 5")


@cache
def kernel() -> FreeCADKernel:
    return FreeCADKernel(timeout=300.0, probe_timeout=300.0)  # a busy machine is no failure


def build(script: str, part: dict[str, Any] = PLATE, *, probe: bool = True) -> BuiltPart:
    return kernel().build(script.encode(), part, probe=probe)


def codes(script: str, **options: Any) -> set[str]:
    with pytest.raises((BuildError, ContractError)) as raised:
        build(script, **options)
    return {finding.code for finding in raised.value.findings}


def test_a_plate_has_its_volume_and_every_dimension_drives_it() -> None:
    built = build(GOOD)
    assert not built.findings, built.findings
    assert built.solid.volume == pytest.approx(40 * 40 * 5 - 4 * 3.141592653589793 * 4 * 5, rel=1e-9)
    assert (built.folder / "part.FCStd").is_file()
    assert built.sandbox == sandbox.level()


def test_a_feature_of_freecads_own_is_tied_by_an_expression() -> None:
    built = build(OWN, PLATE | {"dimensions": {"width": 40.0, "thickness": 5.0}})
    assert not built.findings, built.findings
    edges, bevel = 4 * (40 + 40 + 5), 0.5  # a bevelled corner of a box lacks less than three bevelled edges
    assert 40 * 40 * 5 - edges * bevel**2 / 2 < built.solid.volume < 40 * 40 * 5 - (edges - 24 * bevel) * bevel**2 / 2


@pytest.mark.parametrize("name", ["leg", "drawer_lower"])
def test_both_kernels_build_the_same_solid(name: str) -> None:
    resolved = resolve(ac.AssemblyPlan.load(EXAMPLES / "wardrobe" / "plan.json"))
    told = brief(resolved, name)
    parts = EXAMPLES / "wardrobe" / "parts"
    native = kernel().build((parts / f"{name}.freecad.py").read_bytes(), told, probe=False)
    other = Build123dKernel().build((parts / f"{name}.py").read_bytes(), told, probe=False)
    assert native.solid.volume == pytest.approx(other.solid.volume, rel=1e-6)
    assert native.solid.bbox == pytest.approx(other.solid.bbox, abs=1e-6)
    for connector, frame in other.connectors.items():
        assert native.connectors[connector].frame.allclose(frame.frame, mm=1e-9, rad=1e-9)


def test_a_frozen_shape_is_not_editable() -> None:
    assert "E_NOT_EDITABLE" in codes(FROZEN, probe=False)


@pytest.mark.parametrize(("script", "reason"), [(CYCLE, "cyclic dependency"), (TOO_LARGE, "Bevel (")])
def test_what_freecad_says_of_a_feature_is_told(script: str, reason: str) -> None:
    with pytest.raises(ContractError) as raised:
        build(script, PLATE | {"dimensions": {"width": 40.0, "thickness": 5.0}}, probe=False)
    assert [finding.code for finding in raised.value.findings] == ["E_NOT_EDITABLE"]
    assert reason in raised.value.findings.errors[0].message


def test_a_pattern_that_is_not_the_tip_is_named() -> None:
    assert "E_FEATURE_OFF_TIP" in codes(OFF_TIP, probe=False)


def test_a_dimension_that_no_expression_names_is_told() -> None:
    with pytest.raises(ContractError, match="thickness"):
        build(UNTIED, probe=False)


@pytest.mark.parametrize(
    ("script", "code"),
    [
        ("def build(part):\n    return part.nothing, {}\n", "E_SCRIPT_ERROR"),
        ("def build(part:\n", "E_SCRIPT_ERROR"),
        ("x = 1\n", "E_NO_BUILD"),
        ("def build(part):\n    return 5, {}\n", "E_NO_BUILD"),
        ("import articad\n", "E_SCRIPT_FORBIDDEN"),
        ("open('/etc/pwned', 'w')\n", "E_SCRIPT_FORBIDDEN"),
        ("import socket\nsocket.create_connection(('192.0.2.1', 80), 2)\n", "E_SCRIPT_FORBIDDEN"),
        (GOOD.replace("return", "part.document.addObject('App::FeaturePython', 'Trojan')\n    return"), "E_SCRIPT_FORBIDDEN"),
    ],
)
def test_what_goes_wrong_is_told_by_its_code(script: str, code: str) -> None:
    assert codes(script, probe=False) == {code}


def test_a_misspelled_dimension_is_told_with_the_nearest_one() -> None:
    with pytest.raises(BuildError, match=r"no dimension 'widht'\. Did you mean 'width'\?"):
        build("def build(part):\n    return part.box((0, 0, 0), (part.dimensions['widht'], 9, 9)), {}\n", probe=False)


def test_an_endless_script_ends_at_its_limit() -> None:
    impatient = FreeCADKernel(timeout=-15.0)  # FreeCAD's own start is allowed 20 s more
    with pytest.raises(BuildError) as raised:
        impatient.build(b"while True: pass\n", PLATE)
    assert [finding.code for finding in raised.value.findings] == ["E_SCRIPT_TIMEOUT"]


def test_a_script_that_defies_its_limit_is_killed_and_told_as_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """The signal that it ignores is followed by one that nothing ignores; no lack of memory is told."""
    monkeypatch.setattr("articad.kernels.freecad._START_SECONDS", 0.0)
    monkeypatch.setattr("articad.kernels.freecad_install.WAITING", 20.0)
    impatient = FreeCADKernel(timeout=4.0)
    with pytest.raises(BuildError) as raised:
        impatient.build(b"import signal\nsignal.signal(signal.SIGXCPU, signal.SIG_IGN)\nwhile True: pass\n", PLATE)
    assert [finding.code for finding in raised.value.findings] == ["E_SCRIPT_TIMEOUT"]


def test_waiting_costs_no_processor_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A busy machine makes every script wait."""
    monkeypatch.setattr("articad.kernels.freecad._START_SECONDS", 0.0)
    impatient = FreeCADKernel(timeout=4.0)
    assert impatient.build(f"import time\ntime.sleep(5)\n{GOOD}".encode(), PLATE, probe=False).solid.volume > 0


def test_the_judgement_of_a_tree_needs_no_freecad() -> None:
    tree = {"ok": True, "off_tip": ["Pattern"], "invalid": ["Pad"], "sketched": False, "untied": ["width"]}
    found = [finding.code for finding in tree_findings("plate", tree)]
    assert found.count("E_NOT_EDITABLE") == 3
    assert found.count("E_FEATURE_OFF_TIP") == 1
    assert [finding.code for finding in tree_findings("plate", {"ok": False, "bodies": 2})] == ["E_NOT_EDITABLE"]


def test_a_sweep_follows_its_path_round_mitred_corners() -> None:
    built = build(SWEPT)
    assert built.solid.volume == pytest.approx(5.0 * 5.0 * (40.0 + 40.0 + 40.0), rel=1e-9)  # outline times the length of the centre line
    assert built.solid.bbox.ravel() == pytest.approx([0.0, -2.5, -2.5, 42.5, 42.5, 2.5], abs=1e-6)
