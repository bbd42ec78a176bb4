"""Joints that are made, and the same joints with one fault planted, in random poses."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from build123d import Box, Cylinder, Pos, Sphere

from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.interference.scene import Scene
from articad.kernels.tessellation import tessellate
from articad.kinematics.joints import Joint
from articad.realisation.verdicts import JointCheck, Realisation, check_joints
from tests.interference.mechanisms import at, fixed, joint, random_rotation

DEFLECTION = 0.01  # mm
LYING = SE3.from_axes(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))  # joints whose z is level


@functools.cache
def mesh(shape: Any) -> TriMesh:
    """Return a shape's mesh as the worker makes it: vertices on the surface, and the face of each triangle."""
    found = tessellate(shape.wrapped, DEFLECTION, math.radians(5))
    return TriMesh(found.vertices, found.triangles, found.face)


def judged(
    shapes: Mapping[str, Any],
    kind: str,
    *,
    seed: int = 0,
    others: tuple[Joint, ...] = (),
    frame: SE3 = LYING,
    **limits: Any,
) -> tuple[JointCheck, Realisation]:
    """Return the verdict on joint j of parts a and b, whose shapes are given in the joint's frame; parts stand anywhere in their frames."""
    rng = np.random.default_rng(seed)
    meshes = {name: mesh(shape) for name, shape in shapes.items()}
    inside = {name: at(*rng.uniform(-50, 50, 3)) @ random_rotation(rng) for name in meshes}
    link = joint("j", kind, "a", "b", at_parent=inside["a"], at_child=inside["b"], **limits)
    moved = tuple(
        Joint(**{**other.__dict__, "T_parent_connector": inside[other.parent], "T_child_connector": inside[other.child]})
        for other in others
    )
    scene = Scene.of({name: one.transformed(inside[name]) for name, one in meshes.items()}, [link, *moved], deflection=DEFLECTION)
    poses = {name: frame @ inside[name].inverse() for name in meshes}
    report = check_joints(scene, poses)
    return next(row for row in report.rows if row.joint == "j"), report


@functools.cache
def hinge(
    *, pin: float = 3.0, length: float = 33.0, bore: float = 3.1, knuckles: tuple[float, ...] = (-12.0, 12.0), thick: float = 8.0
) -> dict[str, Any]:
    """A leaf with a pin between two discs, and a leaf with knuckles about the pin."""
    leaf = Cylinder(pin, length) + Pos(0, 0, -length / 2 - 2) * Cylinder(8, 4) + Pos(0, 0, length / 2 + 2) * Cylinder(8, 4)
    other = Pos(0, 24, 0) * Box(4, 30, 40)
    for z in knuckles:
        other += Pos(0, 0, z) * (Cylinder(7, thick) + Pos(0, 9, 0) * Box(6, 12, thick))
    return {"a": leaf, "b": other - Cylinder(bore, 60)}


@pytest.mark.parametrize("kind", ["revolute", "cylindrical"])
@pytest.mark.parametrize("seed", range(2))
def test_a_hinge_is_made_by_its_pin(kind: str, seed: int) -> None:
    limits = {"lower": (-0.1, -1.0), "upper": (0.1, 1.0)} if kind == "cylindrical" else {"lower": (-1.0,), "upper": (1.0,)}
    row, report = judged(hinge(), kind, seed=seed, **limits)
    assert row.verdict == "made"
    assert report.findings.codes == ()
    ((play, count),) = [(play, count) for kind, _, play, count in row.pairs if kind == "pin in bore"]
    assert play == pytest.approx(0.1, abs=1e-6)
    assert count == 2


HINGE_FAULTS: dict[str, dict[str, Any]] = {
    "no pin": {"a": Pos(0, 0, -25) * Box(20, 20, 4), "b": hinge()["b"]},
    "short pin": {"a": Pos(0, 0, -16) * Cylinder(3, 2) + Pos(0, 0, -19) * Box(20, 20, 4), "b": hinge()["b"]},
    "one of two bores missing": hinge(knuckles=(-12.0,), thick=1.0, bore=3.2),
    "bore too wide": hinge(bore=5.0),
    "bore beside the pin": {"a": hinge()["a"], "b": Pos(2, 0, 0) * hinge()["b"]},
    "half a bore": {"a": hinge()["a"], "b": hinge()["b"] - Pos(0, -15.3, 0) * Box(30, 30, 60)},
}


@pytest.mark.parametrize("fault", HINGE_FAULTS)
@pytest.mark.parametrize("seed", range(2))
def test_a_hinge_with_a_fault_is_not_made(fault: str, seed: int) -> None:
    row, report = judged(HINGE_FAULTS[fault], "revolute", seed=seed, lower=(-1.0,), upper=(1.0,))
    assert row.verdict in ("partly", "not made"), row
    assert report.findings.codes[0] in ("W_JOINT_NOT_MADE", "W_JOINT_PARTLY_MADE")


@pytest.mark.parametrize(("reach", "codes"), [(10.0, ()), (34.0, ("W_JOINT_SHORT",)), (41.0, ("W_JOINT_LEAVES",))])
def test_a_pin_that_leaves_its_bore_in_motion(reach: float, codes: tuple[str, ...]) -> None:
    meshes = {"a": Box(30, 30, 40) - Cylinder(5.1, 60), "b": Cylinder(5, 40)}
    row, report = judged(meshes, "cylindrical", lower=(0.0, -1.0), upper=(reach, 1.0))
    assert report.findings.codes == codes
    assert row.share == pytest.approx(max(0.0, 1 - reach / 40), abs=1e-6)
    assert (row.at is not None) == ("W_JOINT_LEAVES" in codes)
    assert row.share_at == {"j.travel": reach}


@pytest.mark.parametrize("notch", [False, True])
@pytest.mark.parametrize(
    ("reach", "codes"),
    [
        (10.0, ("W_JOINT_PARTLY_MADE",)),
        (34.0, ("W_JOINT_PARTLY_MADE", "W_JOINT_SHORT")),
        (41.0, ("W_JOINT_LEAVES",)),
        (-41.0, ("W_JOINT_LEAVES",)),
    ],
)
def test_a_guide_that_leaves_a_way_free_at_rest_is_examined_at_the_ends_too(reach: float, codes: tuple[str, ...], notch: bool) -> None:
    guide = Box(30, 30, 40) - Cylinder(5.1, 60) - (Pos(10, 0, 0) * Box(20, 4, 60) if notch else Pos(0, 0, 0) * Cylinder(5.1, 60))
    row, report = judged({"a": guide, "b": Cylinder(5, 40)}, "slider", lower=(min(0.0, reach),), upper=(max(0.0, reach),))
    assert report.findings.codes == codes, row
    assert (
        {loss.way for loss in row.losses} > {"about z"} if "W_JOINT_LEAVES" in codes else {loss.way for loss in row.losses} == {"about z"}
    )


@functools.cache
def carriage(*, undercut: bool = True, gap: float = 0.2, length: float = 60.0) -> dict[str, Any]:
    """A T-shaped tongue in its groove along z."""
    stem = Pos(0, 9, 0) * Box(10, 20, 30)
    slot = Pos(0, 9 - gap, 0) * Box(10 + 2 * gap, 20, length + 20)
    if not undercut:
        return {"a": Box(40, 30, length) - slot, "b": stem}
    return {
        "a": Box(40, 30, length) - slot - Pos(0, 2, 0) * Box(22 + 2 * gap, 6 + 2 * gap, length + 20),
        "b": stem + Pos(0, 2, 0) * Box(22, 6, 30),
    }


SLIDE: dict[str, Any] = {"lower": (-10.0,), "upper": (10.0,)}


@pytest.mark.parametrize("seed", range(2))
def test_a_tongue_in_its_groove_is_a_slide(seed: int) -> None:
    row, report = judged(carriage(), "slider", seed=seed, **SLIDE)
    assert row.verdict == "made", row
    assert report.findings.codes == ()
    assert row.share == pytest.approx(1.0)


def test_an_open_groove_lets_its_tongue_out() -> None:
    row, report = judged(
        carriage(undercut=False), "slider", frame=SE3.from_axes(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])), **SLIDE
    )
    assert row.verdict == "partly"
    assert [loss.way for loss in row.losses if loss.way.startswith("+")] == ["+y"]
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)


def test_the_weight_holds_a_tongue_in_a_groove_that_is_open_above() -> None:
    row, report = judged(
        carriage(undercut=False), "slider", frame=SE3.from_axes(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])), **SLIDE
    )
    assert all(loss.by_weight for loss in row.losses if loss.way == "+y")
    assert report.findings.codes in ((), ("W_JOINT_PARTLY_MADE",))


@pytest.mark.parametrize(("travel", "codes"), [(30.0, ()), (40.0, ("W_JOINT_SHORT",)), (46.0, ("W_JOINT_LEAVES",))])
def test_a_slide_keeps_a_quarter_of_its_guide(travel: float, codes: tuple[str, ...]) -> None:
    row, report = judged(carriage(), "slider", lower=(0.0,), upper=(travel,))
    assert report.findings.codes == codes, row
    assert row.share == pytest.approx(max(0.0, min(1.0, (45 - travel) / 30)), abs=1e-6)


@functools.cache
def socket(open_at: float) -> Any:
    """A ball's socket that ends at a height above its centre."""
    return Box(40, 40, 40) - Sphere(10.1) - Pos(0, 0, 20 + open_at) * Box(60, 60, 40)


BALL = Sphere(10) + Pos(0, 0, 20) * Cylinder(3, 30)


@pytest.mark.parametrize("seed", range(2))
def test_a_ball_is_held_by_more_than_half(seed: int) -> None:
    row, report = judged({"a": socket(4.0), "b": BALL}, "ball", seed=seed, cone=0.5)
    assert (row.verdict, report.findings.codes) == ("made", ())
    row, report = judged({"a": socket(-1.0), "b": BALL}, "ball", seed=seed, cone=0.5)
    assert row.verdict == "partly"
    assert [loss.way for loss in row.losses] == ["+z"]
    assert report.findings.codes == ("W_JOINT_PARTLY_MADE",)


def test_a_joint_may_be_held_by_another_part() -> None:
    """Two leaves with bores, and a loose pin through both."""
    plain = Box(30, 30, 10) - Cylinder(3.1, 20)
    headed = Cylinder(3, 22) + Pos(0, 0, 11.4) * Cylinder(6, 2) + Pos(0, 0, -11.4) * Cylinder(6, 2)
    meshes = {"a": Pos(0, 0, -5.1) * plain, "b": Pos(0, 0, 5.1) * plain, "pin": headed}
    row, report = judged(meshes, "revolute", lower=(-1.0,), upper=(1.0,), others=(joint("spin", "revolute", "a", "pin"),))
    assert (row.verdict, row.by) == ("held by others", (("pin", "a"),))
    assert "joints.j" not in [finding.where for finding in report.findings]
    without = {name: one for name, one in meshes.items() if name != "pin"}
    assert judged(without, "revolute", lower=(-1.0,), upper=(1.0,))[0].verdict in ("partly", "not made")


def test_a_pin_fixed_to_a_part_belongs_to_it() -> None:
    meshes = {**HINGE_FAULTS["no pin"], "pin": hinge()["a"]}
    row, _ = judged(meshes, "revolute", lower=(-1.0,), upper=(1.0,), others=(fixed("press", "a", "pin"),))
    assert row.verdict == "made"


def test_a_fixed_joint_is_made_by_faces_that_touch() -> None:
    stacked = {"a": Box(20, 20, 10), "b": Pos(0, 0, 10) * Box(10, 10, 10)}
    assert judged(stacked, "fixed")[0].verdict == "made"
    apart = {"a": Box(20, 20, 10), "b": Pos(0, 0, 11) * Box(10, 10, 10)}
    assert judged(apart, "fixed")[0].verdict == "not assessed"


def test_rows_are_told_as_json() -> None:
    row, report = judged(HINGE_FAULTS["half a bore"], "revolute", lower=(-1.0,), upper=(1.0,))
    told = row.to_json()
    assert told["made_by"][0]["kind"] in ("pin in bore", "face to face")
    assert report.to_json()["schema"] == "articad.realisation/1"
    assert all(loss["room"] is None or math.isfinite(loss["room"]) for loss in told["free"])
