"""Built parts are seated by the connector to their tree parent; the deviation at the others is compared with the table of drift."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.errors import BuildError, ContractError
from articad.findings import Findings
from articad.geometry.part import Part
from articad.kernels.build123d import Build123dKernel
from articad.kernels.contract import dimension_findings
from articad.kernels.kernel import BuildCache, BuiltPart, build_part, mirror_part, realise
from articad.kernels.parts import build_parts
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan

WIDTH = 60.0
DIAGONAL = math.sqrt(WIDTH**2 + 40**2 + 4**2)  # 72 mm: the fixed bounds hold, not the shares


def plan(
    latch: dict[str, Any] | None = None, joint: str = "revolute", width: float = WIDTH, envelope: list[float] | None = None
) -> ResolvedPlan:
    limits: dict[str, Any] = {"angle_deg": [0, 90]} if joint == "revolute" else {"cone_deg": 30}
    latch = {"name": "latch", "o": [50, 0, 10], "z": [0, 1, 0], "x": [1, 0, 0]} if latch is None else latch
    form: dict[str, Any] = {
        "schema": "articad.plan/1",
        "name": "gate",
        "description": "A gate with a latch.",
        "ground": "post",
        "freedoms": {"revolute": 2, "ball": 4}[joint],
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": [
            {
                "name": "post",
                "material": "steel",
                "description": "Post.",
                "connectors": [{"name": "hinge", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "hinge"}],
            },
            {
                "name": "gate",
                "material": "steel",
                "description": "Gate.",
                "dimensions": {"width": width},
                "envelope_mm": envelope,
                "connectors": [
                    {"name": "hinge", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "hinge"},
                    latch | {"label": "latch"},
                ],
            },
            {
                "name": "bolt",
                "material": "steel",
                "description": "Bolt.",
                "connectors": [{"name": "a", "o": [50, 0, 10], "z": [0, 1, 0], "label": "bolt"}],
            },
        ],
        "joints": [
            {"name": "hinge", "type": "revolute", "parent": "post.hinge", "child": "gate.hinge", "angle_deg": [0, 90]},
            {"name": "latch", "type": joint, "parent": "gate.latch", "child": "bolt.a", **limits},
        ],
    }
    return resolve(AssemblyPlan.loads(json.dumps(form)))


def script(seat: str = "Pos(0, 0, 0)", latch: str = "Pos(0, 0, 0)", x: str = ", 'x': tuple(latch.x_axis.direction)") -> bytes:
    """A gate whose whole geometry is moved by `seat`, and whose latch is moved by `latch` in its own frame."""
    return (
        "from build123d import *\n"
        "def build(part):\n"
        "    w = part.dimensions['width']\n"
        f"    seat = {seat}\n"
        "    gate = seat * Box(w, 4, 40, align=Align.MIN)\n"
        "    hinge = seat * Location((0, 0, 0))\n"
        f"    latch = seat * Plane((50, 0, 10), x_dir=(1, 0, 0), z_dir=(0, 1, 0)).location * {latch}\n"
        "    def frame(l):\n"
        "        return {'o': tuple(l.position), 'z': tuple(l.z_axis.direction), 'x': tuple(l.x_axis.direction)}\n"
        f"    latch_frame = {{'o': tuple(latch.position), 'z': tuple(latch.z_axis.direction){x}}}\n"
        "    return gate, {'hinge': frame(hinge), 'latch': latch_frame}\n"
    ).encode()


@pytest.fixture
def cache(tmp_path: Path) -> BuildCache:
    return BuildCache(tmp_path / "cache")


def built(resolved: ResolvedPlan, source: bytes, kernel: Build123dKernel, cache: BuildCache) -> tuple[BuiltPart, Part, Findings]:
    result = build_part(resolved, "gate", source, kernel=kernel, cache=cache)
    part, drift = realise(resolved.parts["gate"], result)
    return result, part, result.findings + drift


def test_a_part_built_where_the_plan_has_it_stays_as_it_is(kernel: Build123dKernel, cache: BuildCache) -> None:
    result, part, findings = built(plan(), script(), kernel, cache)

    assert findings == Findings()
    assert part.solid is result.solid
    assert part.mass is not None
    assert part.mass.mass == pytest.approx(WIDTH * 4 * 40 * 7850e-9)
    assert set(part.connectors) == {"hinge", "latch"}
    assert {path.name for path in result.folder.iterdir()} == {"result.json", "part.npz", "part.brep", "part.step", "seal.json"}


@pytest.mark.parametrize("seat", ["Pos(100, -20, 7)", "Pos(5, 5, 5) * Rot(20, 40, 60)"])
def test_a_part_built_elsewhere_is_moved_files_and_all(kernel: Build123dKernel, cache: BuildCache, seat: str) -> None:
    result, part, findings = built(plan(), script(seat=seat), kernel, cache)

    assert findings.codes == ("W_CONNECTOR_DRIFT",)
    assert findings[0].where == "parts.gate.connectors.hinge"
    assert "moved" in findings[0].message
    assert part.solid is not None
    assert part.solid.bbox == pytest.approx(np.array([[0, 0, 0], [WIDTH, 4, 40]]), abs=1e-6)
    assert part.solid.com == pytest.approx([WIDTH / 2, 2, 20], abs=1e-6)
    assert part.solid.step is not None
    assert kernel.read_step(part.solid.step, cache=cache).com == pytest.approx([WIDTH / 2, 2, 20], abs=1e-6)
    assert result.connectors["hinge"].frame.allclose(plan().parts["gate"].connectors["hinge"].frame, mm=1e-6, rad=1e-8)


def drift(kernel: Build123dKernel, cache: BuildCache, moved: str, resolved: ResolvedPlan | None = None) -> tuple[str, ...]:
    try:
        return built(resolved or plan(), script(latch=moved), kernel, cache)[2].codes
    except ContractError as error:
        return error.findings.codes


BOUNDS = {
    "radial": ("Pos({}, 0, 0)", 0.2),
    "along": ("Pos(0, 0, {})", 0.5),
    "axis": ("Rot({}, 0, 0)", 0.25),
    "roll": ("Rot(0, 0, {})", 0.25),
}


@pytest.mark.parametrize("component", BOUNDS)
def test_drift_is_held_to_the_table(kernel: Build123dKernel, cache: BuildCache, component: str) -> None:
    move, bound = BOUNDS[component]

    assert drift(kernel, cache, move.format(0.96 * bound)) == ()
    assert drift(kernel, cache, move.format(1.04 * bound)) == ("W_CONNECTOR_DRIFT",)
    assert drift(kernel, cache, move.format(9.6 * bound)) == ("W_CONNECTOR_DRIFT",)
    assert drift(kernel, cache, move.format(10.4 * bound)) == ("E_CONNECTOR_DRIFT",)


def test_bounds_grow_with_large_parts(kernel: Build123dKernel, cache: BuildCache) -> None:
    """0.2 % of a diagonal of 1 m is 2 mm: ten times what a small part may."""
    large = plan(width=1000)

    assert drift(kernel, cache, "Pos(1.9, 0, 0)", large) == ()
    assert drift(kernel, cache, "Pos(2.1, 0, 0)", large) == ("W_CONNECTOR_DRIFT",)


def test_roll_of_a_ball_is_no_drift(kernel: Build123dKernel, cache: BuildCache) -> None:
    assert drift(kernel, cache, "Rot(0, 0, 90)", plan(joint="ball")) == ()


def test_roll_that_the_plan_leaves_open_is_no_drift(kernel: Build123dKernel, cache: BuildCache) -> None:
    open_roll = plan(latch={"name": "latch", "o": [50, 0, 10], "z": [0, 1, 0]})

    assert drift(kernel, cache, "Rot(0, 0, 90)", open_roll) == ()
    assert built(open_roll, script(x=""), kernel, cache)[2] == Findings()


def test_a_turn_that_the_plan_leaves_open_does_not_turn_the_part(kernel: Build123dKernel, cache: BuildCache) -> None:
    """The bolt hangs by a connector without x: whatever x its script states, the bolt stays as it was built."""
    source = b"from build123d import *\ndef build(part):\n    return Pos(50, 5, 10) * Box(1, 9, 3), {'a': {'o': (50, 0, 10), 'z': (0, 1, 0), 'x': (1, 0, 1)}}\n"
    resolved = plan(latch={"name": "latch", "o": [50, 0, 10], "z": [0, 1, 0]})

    bolt = build_part(resolved, "bolt", source, kernel=kernel, cache=cache)

    assert bolt.solid.bbox == pytest.approx(np.array([[49.5, 0.5, 8.5], [50.5, 9.5, 11.5]]), abs=1e-6)


def test_drift_comes_together_with_the_other_breaches(kernel: Build123dKernel, cache: BuildCache) -> None:
    with pytest.raises(ContractError) as caught:
        build_part(plan(envelope=[WIDTH, 4, 50]), "gate", script(latch="Pos(9, 0, 0)"), kernel=kernel, cache=cache)

    assert sorted(caught.value.findings.codes) == ["E_CONNECTOR_DRIFT", "E_ENVELOPE"]
    assert "9 mm off the axis" in str(caught.value)


def test_a_second_build_is_a_hit_and_a_part_that_follows_its_dimensions_is_not_probed_again(
    kernel: Build123dKernel, cache: BuildCache, monkeypatch: pytest.MonkeyPatch
) -> None:
    probes: list[bool] = []
    build = Build123dKernel.build

    def counted(self: Build123dKernel, *arguments: Any, probe: bool = True, **named: Any) -> BuiltPart:
        probes.append(probe)
        return build(self, *arguments, probe=probe, **named)

    monkeypatch.setattr(Build123dKernel, "build", counted)
    first = built(plan(), script(), kernel, cache)
    again = built(plan(), script(), kernel, cache)
    wider = built(plan(width=70), script(), kernel, cache)

    assert probes == [True, False]
    assert [first[0].cached, again[0].cached, wider[0].cached] == [False, True, False]
    assert first[2].codes == again[2].codes == wider[2].codes == ()
    assert again[0].solid.mesh.digest == first[0].solid.mesh.digest


def test_a_dimension_without_effect_at_one_number_may_have_one_at_another(kernel: Build123dKernel, cache: BuildCache) -> None:
    capped = script().replace(b"w = part.dimensions['width']", b"w = min(part.dimensions['width'], 60.0)")

    for width, codes in ((90, ("W_DIMENSION_UNUSED",)), (50, ()), (80, ())):  # once it has one, the script is known to use it
        assert built(plan(width=width), capped, kernel, cache)[2].codes == codes


def test_checks_that_time_cut_short_are_done_again(kernel: Build123dKernel, cache: BuildCache, monkeypatch: pytest.MonkeyPatch) -> None:
    capped = script().replace(b"w = part.dimensions['width']", b"w = min(part.dimensions['width'], 60.0)")
    with monkeypatch.context() as hurried:
        hurried.setattr(kernel, "limits", replace(kernel.limits, probe_seconds=0.0))
        first, again = (built(plan(width=90), capped, kernel, cache) for _ in range(2))
    in_time = built(plan(width=90), capped, kernel, cache)
    kept = built(plan(width=90), capped, kernel, cache)

    assert [one[2].codes for one in (first, again)] == [("W_BUILD_UNCHECKED",)] * 2
    assert [one[2].codes for one in (in_time, kept)] == [("W_DIMENSION_UNUSED",)] * 2
    assert [one[0].cached for one in (first, again, in_time, kept)] == [False, False, False, True]
    assert first[0].solid.mesh.digest == in_time[0].solid.mesh.digest
    assert (first[0].folder / "part.brep").is_file()  # whoever holds the first part still has its files


def test_a_failed_build_leaves_its_solids_in_the_cache_but_no_hit(kernel: Build123dKernel, cache: BuildCache) -> None:
    failing = script().replace(b"    hinge = seat", b"    raise ValueError('no')\n    hinge = seat")

    for _ in range(2):
        with pytest.raises(BuildError) as caught:
            build_part(plan(), "gate", failing, kernel=kernel, cache=cache)

        assert caught.value.partial is not None
        assert (caught.value.partial / "part.npz").is_file()
        assert caught.value.partial.parent == cache.root


def test_a_mirror_image_is_kept_beside_its_source(kernel: Build123dKernel, cache: BuildCache) -> None:
    source = build_part(plan(), "gate", script(), kernel=kernel, cache=cache)
    S = np.diag([-1.0, 1.0, 1.0, 1.0])

    image, again = mirror_part(kernel, source, S), mirror_part(kernel, source, S)

    assert image.folder.parent == cache.root
    assert image.folder == again.folder
    assert image.solid.bbox == pytest.approx(np.array([[-WIDTH, 0, 0], [0, 4, 40]]))
    assert image.connectors["latch"].frame.allclose(source.connectors["latch"].mirrored(S).frame)


@pytest.mark.parametrize("by", [1 / 25.4, 1e-3])
def test_one_dimension_far_longer_than_the_part_is_the_plans_fault_and_several_are_the_scripts(by: float) -> None:
    gate = plan().parts["gate"]
    box = np.array([[0, 0, 0], [WIDTH, 4, 40]])

    def codes(bbox: Any, **dimensions: float) -> list[tuple[str, str | None]]:
        return [(one.code, one.route) for one in dimension_findings(replace(gate, dimensions=dimensions), bbox)]

    assert codes(box, width=WIDTH, height=40, swing_deg=720, slat_count=900) == []
    assert codes(box, width=WIDTH, height=40 / by) == [("W_SCALE", "design")]
    assert codes(box * by, width=WIDTH, height=40, depth=4) == [("W_PART_SCALE", "code")]


@pytest.mark.parametrize("name", ["thickness", "wall", "side_thickness"])
def test_a_thickness_out_of_proportion_is_the_plans_fault(name: str) -> None:
    gate = plan().parts["gate"]

    def codes(size: tuple[float, float, float], density: float, **dimensions: float) -> list[tuple[str, str]]:
        material = replace(gate.material, density=density)
        found = dimension_findings(replace(gate, dimensions=dimensions, material=material), np.array([[0, 0, 0], size]))
        return [(one.code, one.where.rsplit(".", 1)[-1]) for one in found]

    assert codes((600, 18, 400), 700, **{name: 18, "width": 600}) == []
    assert codes((20, 8000, 200), 7850, **{name: 8000, "width": 200}) == [("W_SCALE", name)]  # longer than the part is wide
    assert codes((600, 0.7, 400), 700, **{name: 0.7, "width": 600}) == [("W_SCALE", name)]  # wood like foil
    assert codes((600, 0.7, 400), 7850, **{name: 0.7, "width": 600}) == []  # sheet metal
    assert codes((600, 0.7, 400), 700, depth=0.7, width=600) == []


def test_all_parts_of_a_plan_are_built(kernel: Build123dKernel, cache: BuildCache) -> None:
    """The fixture with one joint of each kind: every part is one valid solid and without a finding."""
    folder = Path(__file__).parents[1] / "fixtures" / "five_joints"
    resolved = resolve(AssemblyPlan.load(folder))
    scripts = {name: (folder / "parts" / f"{name}.py").read_bytes() for name, part in resolved.parts.items() if part.derivation is None}

    parts = build_parts(resolved, scripts, kernel=kernel, cache=cache, deflection=0.01)

    assert list(parts) == list(resolved.parts)
    for name, part in parts.items():
        assert part.findings == Findings(), name
        assert part.part.mesh is not None
        assert part.part.mesh.is_closed
