"""All breaches of a script's contract are reported at once, each with its numbers."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import pytest
from hypothesis import given
from hypothesis.strategies import floats, lists

from articad.errors import BuildError, ContractError, KernelError
from articad.findings import Finding, Findings
from articad.kernels.build123d import Build123dKernel
from articad.kernels.dimensions import probed
from articad.kernels.results import read_mesh
from tests.kernels.conftest import Build, frame

HAS_FONTS = any(Path("/usr/share/fonts").rglob("*.[to]tf"))

A = {"a": frame()}
A_RETURNED = "{'a': {'o': (0, 0, 0), 'z': (0, 0, 1)}}"


def findings(build: Build, body: str, **changes: Any) -> Findings:
    try:
        return build(body, **changes).findings
    except KernelError as error:
        return error.findings


def only(found: Findings, code: str) -> Finding:
    assert found.codes == (code,), str(found)
    return found[0]


def test_a_part_that_keeps_its_contract_has_no_finding(build: Build) -> None:
    part = build(f"return Box(d['w'], 20, 5), {A_RETURNED}", connectors=A, dimensions={"w": 10.0}, envelope_mm=[10, 20, 5], probe=True)

    assert part.findings == Findings()
    assert part.connectors["a"].frame.allclose(part.connectors["a"].frame.identity())


def test_all_breaches_come_at_once(build: Build) -> None:
    body = "return Box(10, 10, 10) + Pos(50, 0, 0) * Box(1, 1, 1), {'b': {'o': (0, 0, 0), 'z': (0, 0, 1)}}"

    with pytest.raises(ContractError) as caught:
        build(body, connectors=A, envelope_mm=[10, 10, 10])

    assert sorted(caught.value.findings.codes) == ["E_CONNECTOR_EXTRA", "E_CONNECTOR_MISSING", "E_NOT_ONE_SOLID"]
    assert caught.value.parts == ("lug",)
    assert all(finding.route == "code" for finding in caught.value.findings)


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("x = 1", "returned None"),
        ("return Box(1, 1, 1)", r"returned a Box, not \(shape, connectors\)"),
        ("return 'box', {}", "is a str, not a build123d"),
        ("with BuildPart() as p:\n    Box(1, 1, 1)\nreturn p, {}", r"return its \.part"),
        ("return Box(1, 1, 1), []", "connectors are a list"),
        ("return Box(1, 1, 1), {'a': (0, 0, 0)}", "Connector 'a' is a tuple"),
        ("return Box(1, 1, 1), {'a': {'o': (0, 0, 0)}}", "is a dict with 'o'; it must be"),
        ("return Box(1, 1, 1), {'a': {'o': (0, 0), 'z': (0, 0, 1)}}", "o is not three finite numbers"),
        ("return Box(1, 1, 1), {'a': {'o': (0, 0, nan), 'z': (0, 0, 1)}}", "o is not three finite numbers"),
    ],
)
def test_what_is_no_part_is_E_NO_BUILD(build: Build, body: str, says: str) -> None:
    with pytest.raises(BuildError, match=says) as caught:
        build(body, connectors=A)

    assert set(caught.value.findings.codes) == {"E_NO_BUILD"}


def test_a_script_without_build_is_E_NO_BUILD(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    with pytest.raises(BuildError, match=r"no function build\(part\)"):
        kernel.build(b"x = 1\n", brief)


def test_axes_that_make_no_frame_are_told(build: Build) -> None:
    found = findings(build, "return Box(1, 1, 1), {'a': {'o': (0, 0, 0), 'z': (0, 0, 1), 'x': (0, 0, 2)}}", connectors=A)

    assert found.codes == ("E_NO_BUILD",)
    assert found[0].where == "parts.lug.connectors.a"


def test_a_builders_part_and_one_solid_compounds_are_shapes(build: Build) -> None:
    for body in (
        "with BuildPart() as p:\n    Box(1, 2, 3)\nreturn p.part, {}",
        "return Compound(children=[Box(1, 2, 3)]), {}",
        "return Box(1, 2, 3).solid(), {}",
        "return [Box(1, 2, 3)], {}",
        "return Part() + Box(1, 2, 3), {}",
    ):
        assert build(body).solid.volume == pytest.approx(6)


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("return Box(9, 9, 9) - Box(10, 10, 10), {}", "E_EMPTY_SOLID"),
        ("return Part(), {}", "E_EMPTY_SOLID"),
        ("return Box(0.05, 0.05, 0.05), {}", "E_EMPTY_SOLID"),
        ("return Rectangle(3, 4), {}", "E_NOT_ONE_SOLID"),
        ("return Compound(children=[Box(1, 1, 1), Pos(5, 0, 0) * Rectangle(1, 1).face()]), {}", "E_NOT_ONE_SOLID"),
        ("return Box(9, 9, 9) + Pos(9, 9, 0) * Box(9, 9, 9), {}", "E_NOT_ONE_SOLID"),
    ],
)
def test_what_is_not_one_solid_is_told(build: Build, body: str, code: str) -> None:
    assert only(findings(build, body), code)


def test_faces_that_cut_each_other_are_told(build: Build) -> None:
    """A tube along a path that crosses itself: OCCT's own check calls it valid."""
    body = (
        "path = Wire([Line((0, 0), (20, 0)).edge(), CenterArc((20, 6), 6, -90, 270).edge(), Line((14, 6), (14, -10)).edge()])\n"
        "return sweep(Plane((0, 0, 0), z_dir=(1, 0, 0)) * Circle(1), path=path), {}"
    )

    finding = only(findings(build, body), "E_INVALID_SOLID")

    assert "cut each other near" in finding.message


def trunnion(eye: float, wide: float) -> str:
    """A rod of 8 mm radius, chamfered at its foot, with an eye across its top, `wide` along x, and a pin through that."""
    return (
        "tail = Pos(0, 0, -585) * Cylinder(8, 585, align=(Align.CENTER, Align.CENTER, Align.MIN))\n"
        f"body = chamfer(tail.edges().sort_by(Axis.Z)[0], 1) + Rot(0, 90, 0) * Cylinder({eye}, {wide})\n"
        "return body + Rot(0, 90, 0) * Cylinder(3, 26.6), {}"
    )


@pytest.mark.parametrize(
    ("eye", "wide", "kept"), [(8.0, 16.0, False), (7.0, 16.0, False), (7.0, 16.2, True), (8.1, 16.2, True), (8.5, 16.0, True)]
)
def test_a_solid_that_step_does_not_keep_is_told(build: Build, eye: float, wide: float, kept: bool) -> None:
    """The ends of the eye touch the rod's side, until it is as the hint says: the kernel calls it valid with the tolerances of its edges, which STEP does not state."""
    built = build(trunnion(eye, wide))

    if kept:
        assert built.findings == Findings()
    else:
        only(built.findings, "W_PART_STEP")


@pytest.mark.skipif(not HAS_FONTS, reason="without fonts the kernel draws simpler letters, which it can judge")
def test_faces_that_the_kernel_gives_up_on_are_told_as_unchecked(build: Build) -> None:
    found = build("return Box(20, 20, 4) + Pos(0, 0, 2) * extrude(Text('t', 10), 1), {}").findings

    only(found, "I_BUILD_UNCHECKED")


def test_envelope_is_held_to_two_per_cent(build: Build) -> None:
    assert build("return Box(10.19, 20, 5), {}", envelope_mm=[10, 20, 5]).findings == Findings()

    finding = only(findings(build, "return Box(10.21, 20, 5), {}", envelope_mm=[10, 20, 5]), "E_ENVELOPE")

    assert finding.value == pytest.approx(10.21)
    assert finding.limit == 10
    assert "along x" in finding.message


# ---------------------------------------------------------------------- the dimension probe


def test_every_dimension_that_drives_the_part_passes_the_probe(build: Build) -> None:
    body = (
        "s = Box(d['w'], d['h'], 5)\n"
        "for i in range(d['hole_count']):\n"
        "    s -= Pos(4 * i - 4, d['y'], 0) * Cylinder(1, 9)\n"
        "s = Rot(0, 0, d['turn_deg']) * s\n"
        f"return s, {A_RETURNED.replace('(0, 0, 0)', '(d[chr(120)], 0, 0)')}"
    )
    dimensions = {"w": 30.0, "h": 10.0, "y": 0.0, "x": -3.0, "turn_deg": 0.0, "hole_count": 2}

    part = build(body, connectors={"a": frame((-3, 0, 0))}, dimensions=dimensions, probe=True)

    assert part.findings == Findings()


def test_a_dimension_that_changes_nothing_is_told(build: Build) -> None:
    found = build("return Box(d['w'], 10, 10), {}", dimensions={"w": 10.0, "dead": 3.0, "dead_count": 2}, probe=True).findings

    assert found.codes == ("W_DIMENSION_UNUSED", "W_DIMENSION_UNUSED")
    assert [finding.where for finding in found] == ["parts.lug.dimensions.dead", "parts.lug.dimensions.dead_count"]
    assert all("does not name it" in finding.message for finding in found)


def test_a_dimension_that_another_body_swallows_is_not_called_a_literal_number(build: Build) -> None:
    body = "return Box(d['w'], 10, 10) + Cylinder(1, d['inner']), {}"
    (finding,) = build(body, dimensions={"w": 10.0, "inner": 3.0}, probe=True).findings
    assert (finding.code, finding.where) == ("W_DIMENSION_UNUSED", "parts.lug.dimensions.inner")
    assert "The script names it" in finding.message
    assert "literal" not in f"{finding.message} {finding.hint}"
    assert build(
        "return Box(d['w'], 10, 10) + Cylinder(1, 30 * d['inner']), {}", dimensions={"w": 10.0, "inner": 3.0}, probe=True
    ).findings.ok


AWAY: Final = {"bore": (0, 20, 0), "pin": (0, 0, -4), "depth": (0, 0, -6), "groove": (0, 0, 30)}
OF_JOINTS: Final = {
    "bore": ({"swing_bore": 3.0}, "the diameter of the bore", "only air"),
    "pin": ({"swing_pin": 3.0, "swing_length": 4.0}, "the diameter of the pin", "inside the part's own body"),
    "depth": ({"swing_bore": 3.0, "swing_depth": 12.0}, "the depth of the hole", "ends in the air"),
    "groove": ({"swing_groove": 3.0, "swing_width": 1.0, "swing_shaft": 4.0}, "the diameter of the groove", "only air"),
}


@pytest.mark.parametrize("kind", OF_JOINTS)
def test_a_feature_of_a_standard_joint_without_effect_is_told_with_its_joint(build: Build, kind: str) -> None:
    """A script that makes none of them is told how; of one that makes them, the place is wrong. The cutter of a groove may stand in the air."""
    dimensions, what, why = OF_JOINTS[kind]
    connectors = {"swing": frame(AWAY[kind], [{"name": "door", "type": "revolute"}])}
    for body, words in (("part.made(Box(10, 10, 10))", why), ("Box(10, 10, 10), part.connectors", "Return part.made(shape)")):
        found = build(f"return {body}", dimensions=dimensions, connectors=connectors, probe=True).findings.of("W_DIMENSION_UNUSED")
        finding = next(one for one in found if one.where == f"parts.lug.dimensions.swing_{kind}")
        assert f"It is {what} of standard joint 'door'." in finding.message
        assert words in f"{finding.message} {finding.hint}"
        assert not any("shaft" in one.where for one in found)


@pytest.mark.parametrize(
    ("stated", "missing"), [("gap", "reach"), ("pin", "length"), ("span", "pin"), ("bar_x", "bar_y"), ("groove", "shaft")]
)
def test_a_dimension_that_happens_to_be_named_after_a_connector_says_what_it_lacks(build: Build, stated: str, missing: str) -> None:
    """The connectors of a short plan are named after its joints: a part with a flag has the dimension flag_gap easily."""
    with pytest.raises(BuildError) as raised:
        build("return part.made(Box(10, 10, 10))", dimensions={f"flag_{stated}": 3.0}, connectors={"flag": frame()})
    (finding,) = raised.value.findings

    assert f"the dimension flag_{stated} is named after the connector flag" in finding.message
    assert f"flag_{missing}" in finding.message
    assert "rename the dimension" in finding.message


@pytest.mark.parametrize("read", ["d['widht']", "d.widht", "part.dimensions['widht']"])
def test_a_misspelled_dimension_is_told_with_the_nearest_one(build: Build, read: str) -> None:
    with pytest.raises(BuildError) as raised:
        build(f"return Box({read}, 9, 9), {{}}", dimensions={"width": 10.0, "depth": 3.0})
    (finding,) = raised.value.findings
    assert "has no dimension 'widht'. Did you mean 'width'? It has width, depth." in finding.message


def test_a_dimension_that_is_only_named_like_a_feature_is_that_of_no_joint(build: Build) -> None:
    connectors = {"lid": frame()}
    (finding,) = build(
        "return Box(10, 10, 10), part.connectors", dimensions={"lid_length": 5.0}, connectors=connectors, probe=True
    ).findings
    assert "joint" not in finding.message


def test_a_script_may_return_the_planned_connectors(build: Build) -> None:
    part = build("return Box(10, 10, 10), part.connectors", connectors={"a": frame((1, 2, 3))})
    assert part.connectors["a"].frame.translation.tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    "body",
    [
        "import math\nn = getattr(math, 'runs', 0)\nmath.runs = n + 1\nreturn Box(10 + n, 10, 10), {}",
        "import math\nmath.first = getattr(math, 'first', d['w'])\nreturn Box(10 + d['w'] - math.first, 10, 10), {}",
        (
            "import OCP.GProp\nclass Other(OCP.GProp.GProp_GProps):\n    def Mass(self):\n        return d['w']\n"
            "OCP.GProp.GProp_GProps = Other\nimport sys\nfor m in list(sys.modules.values()):\n"
            "    if hasattr(m, 'GProp_GProps'):\n        m.GProp_GProps = Other\nreturn Box(10, 10, 10), {}"
        ),
    ],
    ids=["counts its runs", "remembers the first", "changes how it is measured"],
)
def test_a_script_cannot_pretend_to_use_a_dimension(build: Build, body: str) -> None:
    """Every run has a process of its own, and another process measures what it leaves."""
    assert build(body, dimensions={"w": 3.0}, probe=True).findings.codes == ("W_DIMENSION_UNUSED",)


def test_a_dimension_at_which_the_kernel_crashes_hides_no_other(build: Build) -> None:
    body = "if d['h'] != 3:\n    import ctypes\n    ctypes.string_at(0)\nreturn Box(d['h'], 5, 5), {}"
    found = findings(build, body, dimensions={"h": 3.0, "dead": 10.0}, probe=True)
    assert found.codes == ("E_NOT_EDITABLE", "W_DIMENSION_UNUSED")


def test_a_dimension_that_may_move_one_way_only_is_fine(build: Build) -> None:
    """A bore as wide as the wall allows cannot grow by 2 %, but it can shrink: where that is valid, says the contract."""
    body = "if d['bore'] > 10:\n    raise RuntimeError('too wide')\nreturn Box(30, 30, 5) - Cylinder(d['bore'], 9), {}"

    assert build(body, dimensions={"bore": 10.0}, probe=True).findings == Findings()


def test_a_script_that_breaks_when_a_dimension_moves_is_not_editable(build: Build) -> None:
    body = "s = Box(d['w'], 10, 10)\nedges = [e for e in s.edges() if e.center().X == 15.0]\nreturn fillet(edges[:1][0], 1), {}"

    finding = only(findings(build, body, dimensions={"w": 30.0}, probe=True), "E_NOT_EDITABLE")

    assert finding.where == "parts.lug.dimensions.w"
    assert "IndexError" in finding.message
    assert "line 9" in finding.message


def test_falling_apart_when_a_dimension_moves_is_not_editable(build: Build) -> None:
    body = "gap = 0 if d['w'] == 10 else 1\nreturn Box(d['w'], 10, 10) + Pos(10 + gap, 0, 0) * Box(10, 10, 10), {}"

    finding = only(findings(build, body, dimensions={"w": 10.0}, probe=True), "E_NOT_EDITABLE")

    assert "2 solids" in finding.message


def test_a_script_may_refuse_a_change_in_its_own_words(build: Build) -> None:
    body = "if d['pitch'] != 2 * d['module']:\n    raise ValueError('pitch must be twice the module')\nreturn Box(d['pitch'], 1, 1), {}"

    found = build(body, dimensions={"pitch": 4.0, "module": 2.0}, probe=True).findings

    assert found.codes == ("W_DIMENSION_REFUSED", "W_DIMENSION_REFUSED")
    assert "pitch must be twice the module" in found[0].message


def test_a_crash_in_the_probe_keeps_the_breach_and_names_the_dimension(build: Build) -> None:
    body = "if d['w'] != 10:\n    import ctypes\n    ctypes.string_at(0)\nreturn Box(d['w'], d['h'], 5), {}"

    found = findings(build, body, dimensions={"h": 3.0, "w": 10.0}, probe=True)

    assert found.errors[0].code == "E_NOT_EDITABLE"
    assert found.errors[0].where == "parts.lug.dimensions.w"


def test_a_probe_that_does_not_end_does_not_lose_the_part(build: Build) -> None:
    found = build("while d['w'] != 10:\n    pass\nreturn Box(d['w'], 5, 5), {}", dimensions={"w": 10.0}, probe=True).findings

    finding = only(found, "W_BUILD_UNCHECKED")
    assert "w" in finding.message


WAITS = "import time\ntime.sleep(1.0)\nreturn Box(d['w'], d['h'], d['t']), {}"  # as on a busy machine: wall clock without processor time
UNUSED = {"w": 10.0, "h": 5.0, "t": 5.0, "depth": 3.0}


def test_a_probe_that_gets_no_processor_loses_no_dimension(build: Build, kernel: Build123dKernel, monkeypatch: pytest.MonkeyPatch) -> None:
    """Five builds wait longer than the time of the probe, but use less of the processor."""
    monkeypatch.setattr(kernel, "limits", replace(kernel.limits, probe_seconds=4.0))
    found = build(WAITS, dimensions=UNUSED, probe=True).findings
    assert [(one.code, one.where) for one in found] == [("W_DIMENSION_UNUSED", "parts.lug.dimensions.depth")]


def test_a_probe_that_only_waits_ends(build: Build, kernel: Build123dKernel, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "limits", replace(kernel.limits, probe_seconds=1.0))
    started = time.monotonic()
    found = build(
        "while d['w'] != 10:\n    import time\n    time.sleep(1)\nreturn Box(d['w'], 5, 5), {}", dimensions={"w": 10.0}, probe=True
    )
    assert found.findings.codes == ("W_BUILD_UNCHECKED",)
    assert time.monotonic() - started < 60.0  # five seconds of waiting


@given(used=lists(floats(0.1, 3.0), min_size=1, max_size=6), waited=floats(0.0, 2.0))
def test_a_probe_spends_processor_time_and_not_the_clock(used: list[float], waited: float) -> None:
    """Each dimension without effect takes two builds; the budget is enough for all of them."""
    now = [0.0]

    def attempt(dimensions: dict[str, float], _seconds: float) -> tuple[list[float], float]:
        spent = next(used[int(name)] for name, value in dimensions.items() if value != 1.0)
        now[0] += spent * (1.0 + waited)
        return [1.0], spent

    numbers = {str(at): 1.0 for at in range(len(used))}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("articad.kernels.dimensions.time.monotonic", lambda: now[0])
        outcomes = list(probed(numbers, [1.0], attempt, seconds=2 * sum(used) + 0.1, own=1.0))
        few = list(probed(numbers, [1.0], attempt, seconds=2 * sum(used[:-1]) + used[-1] / 2, own=1.0))
    assert [one["outcome"] for one in outcomes] == ["unused"] * len(used)
    assert len(few) == len(used) - 1


def test_a_part_that_breaks_its_contract_hands_back_its_solids(build: Build) -> None:
    with pytest.raises(ContractError) as caught:
        build("return Box(10, 10, 10) + Pos(50, 0, 0) * Box(1, 1, 1), {}")

    assert caught.value.partial is not None
    mesh = read_mesh((caught.value.partial / "part.npz").read_bytes())
    assert mesh.volume == pytest.approx(1001)
    assert mesh.face is not None
    assert set(mesh.face.tolist()) == {0, 1}
