"""FCStd, URDF, MJCF and plan, each from each other: every example, and 200 random mechanisms of all joint kinds, with and without loops."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError, UnrepresentableError
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad_alone
from articad.export.mjcf import write_mjcf
from articad.export.plan import plan_name, plan_of, write_plan
from articad.export.urdf import write_urdf
from articad.geometry.part import Part
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.kinematics import declare
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from tests.assemblies import all_joint_kinds, block, frame, geared_pair, random_configurations, random_tree

FloatArray = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = [*sorted(path.parent for path in ROOT.glob("examples/*/plan.json")), ROOT / "tests/fixtures/five_joints"]
FORMATS: dict[str, tuple[Callable[..., Bundle], Callable[..., Assembly], dict[str, Any]]] = {
    "urdf": (write_urdf, read_urdf, {"meshes": "obj"}),
    "mjcf": (write_mjcf, read_mjcf, {"meshes": "obj"}),
    "freecad": (write_freecad_alone, read_freecad, {}),
}
ROUND = ("freecad", "urdf", "mjcf", "freecad")  # with its reverse: every format from every other
SOME_TREES, SOME_LOOPS = 12, 5  # random mechanisms that are taken round with the other tests; `-m soak` takes the rest
ALL = 100
TOLERANCE = 1e-9  # m, and entries of rotation matrices
CONFIGURATIONS = 1000
FARTHEST_MM, FARTHEST_RAD = 10.0, 0.1  # from rest, of each driver of a loop, where the loop lets it
SHARE_OF_SIGMA = 5.0  # of that box: where loops are near a singularity they are followed in small steps
TIMES_HALVED = 10


def random_loop(seed: int) -> Assembly:
    """A random chain of joints that move, closed by a joint of a random kind where its ends are at rest; a loop that can move."""
    rng = np.random.default_rng(seed)
    kinds = [JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL, JointType.UNIVERSAL, JointType.REVOLUTE]
    kind = [JointType.REVOLUTE, JointType.BALL, JointType.CYLINDRICAL, JointType.UNIVERSAL, JointType.PLANAR, JointType.SLIDER][seed % 6]
    parts: list[Part] = [block("base", root=frame(), tip=_random_frame(rng))]
    joints: list[Joint] = []
    count = int(rng.integers(4, 7))
    while len(joints) < count or sum(joint.type.freedoms for joint in joints) + kind.freedoms <= 6:
        index = len(joints)
        part = block(f"part_{index}", root=_random_frame(rng), tip=_random_frame(rng))
        joints.append(_joint(kinds[rng.integers(len(kinds))], f"joint_{index}", parts[-1]["tip"], part["root"]))
        parts.append(part)
    tip = SE3.identity()
    for joint in joints:
        tip = tip @ joint.T_parent_connector @ joint.motion(joint.rest) @ flip(joint.mate) @ joint.T_child_connector.inverse()
    draft = _joint(kind, "closing", parts[0]["root"], parts[-1]["tip"])
    seat = tip @ parts[-1]["tip"].connector.frame @ flip(draft.mate).inverse() @ draft.motion(draft.rest).inverse()
    base = block("base", root=seat, tip=parts[0]["tip"].connector.frame)
    closing = _joint(kind, "closing", base["root"], parts[-1]["tip"])
    # without shapes: looking for contacts over the motion of a loop is not what is tested
    bare = [Part.without_geometry(part.name, part.connectors, part.mass) for part in (base, *parts[1:])]
    return Assembly.from_parts("loop", parts=bare, joints=[*joints, closing], ground="base")


def _random_frame(rng: np.random.Generator) -> SE3:
    return SE3.exp(np.concatenate([rng.uniform(-80, 80, 3), rng.uniform(-1, 1, 3)]))


def _joint(kind: JointType, name: str, near: Any, far: Any) -> Joint:
    made: dict[JointType, Callable[[], Joint]] = {
        JointType.REVOLUTE: lambda: declare.revolute(name, near, far, limits=(-2.0, 2.0)),
        JointType.SLIDER: lambda: declare.slider(name, near, far, limits=(-90.0, 90.0)),
        JointType.CYLINDRICAL: lambda: declare.cylindrical(name, near, far, travel=(-90.0, 90.0), angle=(-2.0, 2.0)),
        JointType.BALL: lambda: declare.ball(name, near, far, cone=1.4),
        JointType.UNIVERSAL: lambda: declare.universal(name, near, far, a=(-1.2, 1.2), b=(-1.2, 1.2)),
        JointType.PLANAR: lambda: declare.planar(name, near, far, x=(-90.0, 90.0), y=(-90.0, 90.0), angle=(-2.0, 2.0)),
    }
    return made[kind]()


def there_and_back(assembly: Assembly, folder: Path, ways: Sequence[str] = ("urdf", "mjcf")) -> Assembly:
    """Return the assembly after a way through formats, each written from what the one before it gave back."""
    for step, way in enumerate(ways):
        write, read, options = FORMATS[way]
        bundle = write(assembly, **options)
        bundle.write(folder / f"{step}_{way}")
        assembly = read(folder / f"{step}_{way}" / bundle.main)
    return assembly


def closed(mechanism: Mechanism, seed: int) -> FloatArray:
    """Return a thousand configurations that close: in a box around rest, the smaller the nearer another branch is."""
    share = 1.0
    for group in mechanism.branch.groups:
        sigma = group.follower.linearized(group.Q).s[: group.follower.rank]
        share = min(share, SHARE_OF_SIGMA * float(sigma.min() / sigma.max())) if len(sigma) else share
    far = np.array([FARTHEST_MM if driver.unit == "mm" else FARTHEST_RAD for driver in mechanism.drivers])
    away = far * np.random.default_rng(seed).uniform(-1, 1, (CONFIGURATIONS, len(far)))
    for _ in range(TIMES_HALVED):
        q = unit_balls(mechanism, mechanism.rest + share * away)
        try:
            mechanism.poses(q)
        except KinematicsError:
            share /= 2
        else:
            assert len(np.unique(q, axis=0)) == CONFIGURATIONS
            return q
    raise AssertionError("the loops close nowhere but at rest")


def unit_balls(mechanism: Mechanism, q: FloatArray) -> FloatArray:
    """Return configurations with quaternions of unit length."""
    columns = {name: index for index, name in enumerate(driver.name for driver in mechanism.drivers)}
    for joint in mechanism.joints:
        if joint.type is JointType.BALL and f"{joint.name}.qw" in columns:
            at = [columns[f"{joint.name}.{axis}"] for axis in ("qx", "qy", "qz", "qw")]
            q[:, at] /= np.linalg.norm(q[:, at], axis=1, keepdims=True)
    return q


def bounds(joint: Joint) -> list[float]:
    limits = joint.limits
    return [*limits.lower, *limits.upper, math.pi if limits.cone is None else limits.cone, *(limits.twist or ())]


def metres(poses: SE3) -> FloatArray:
    matrices = poses.matrix.copy()
    matrices[..., :3, 3] /= 1000
    return matrices


def assert_equal(first: Assembly, again: Assembly, q: FloatArray) -> None:
    """Names, limits, masses and poses of an assembly, and of the plan that describes it, are the same."""
    assert list(again.parts) == list(first.parts)
    assert again.joints == first.joints
    assert again.mechanism.couplings == first.mechanism.couplings
    for name, part in first.parts.items():
        assert (again.parts[name].mass is None) == (part.mass is None)
        if part.mass is not None:
            assert again.parts[name].mass.mass == part.mass.mass  # type: ignore[union-attr]
            assert (again.parts[name].mass.inertia == part.mass.inertia).all()  # type: ignore[union-attr]
    here = metres(first.poses(q))
    assert np.abs(metres(again.poses(q)) - here).max() < TOLERANCE
    assert_told(first, again.to_plan(), q, here)


def assert_told(first: Assembly, plan: AssemblyPlan, q: FloatArray, here: FloatArray) -> None:
    told = resolve(AssemblyPlan.loads(plan.dumps()))
    assert list(told.parts) == [plan_name(name) for name in first.parts]
    for joint, given in zip(told.joints, first.joints, strict=True):
        assert (joint.type, joint.mate) == (given.type, given.mate)
        assert bounds(joint) == pytest.approx(bounds(given), rel=1e-15)
    assert [driver.name for driver in told.mechanism.drivers] == [driver.name for driver in first.drivers]
    assert np.abs(metres(told.mechanism.poses(q)) - here).max() < TOLERANCE


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=[path.name for path in EXAMPLES])
def test_an_example_comes_back(example: Path, tmp_path: Path) -> None:
    plan = AssemblyPlan.load(example)
    first = Assembly.from_plan(plan, example / "parts")
    again = there_and_back(first, tmp_path, ROUND[::-1] if EXAMPLES.index(example) % 2 else ROUND)
    mechanism = first.mechanism
    q = closed(mechanism, 0) if mechanism.loop_joints or mechanism.couplings else random_configurations(first, 0, CONFIGURATIONS)

    assert_equal(first, again, q)
    assert first.to_plan() == plan


def seeds(some: int) -> list[Any]:
    """Seeds of random mechanisms; those beyond the first few are marked."""
    return [seed if seed < some else pytest.param(seed, marks=pytest.mark.soak) for seed in range(ALL)]


@pytest.mark.parametrize("seed", seeds(SOME_TREES))
def test_a_random_tree_comes_back(seed: int, tmp_path: Path) -> None:
    first = random_tree(seed, 3 + seed % 7)
    again = there_and_back(first, tmp_path, ROUND[:: 1 - 2 * (seed % 2)])

    assert_equal(first, again, random_configurations(first, seed, CONFIGURATIONS))


@pytest.mark.parametrize("seed", seeds(SOME_LOOPS))
def test_a_random_loop_comes_back(seed: int, tmp_path: Path) -> None:
    first = random_loop(seed)

    assert_equal(first, there_and_back(first, tmp_path, ROUND[:: 1 - 2 * (seed % 2)]), closed(first.mechanism, seed))


def test_gears_come_back(tmp_path: Path) -> None:
    first = geared_pair()

    assert_equal(first, there_and_back(first, tmp_path), np.linspace(-3, 3, CONFIGURATIONS)[:, None])


def test_a_plan_that_is_told_is_free_of_errors_and_tells_its_losses() -> None:
    plan, _ = plan_of(all_joint_kinds())
    losses = write_plan(all_joint_kinds()).losses

    assert check_plan(plan).ok
    assert {loss.where for loss in losses if loss.lost.startswith("the rest value of the joint")} == {"joints.knob"}
    assert {loss.where for loss in losses if loss.refused} == {"parts"}


def test_names_become_plan_names_each_once() -> None:
    base = block("Base-Link", a=frame(), b=frame())
    parts = [base, *(block(name, root=frame()) for name in ("l_1", "L 1", "for", "3rd", "x" * 60, "x" * 61))]
    joints = [declare.revolute(f"J{i}", base["a"], part["root"], limits=(0, 1)) for i, part in enumerate(parts[1:])]
    plan = Assembly.from_parts("My Robot", parts=parts, joints=joints, ground="Base-Link").to_plan()

    assert [part.name for part in plan.parts] == ["base_link", "l_1", "l_1_2", "for_1", "n3rd", "x" * 40, "x" * 38 + "_2"]
    assert plan.ground == "base_link"


def test_a_loop_that_rests_where_a_plan_cannot_is_refused() -> None:
    base, part = block("base", a=frame(), b=frame(at=(30, 0, 0))), block("part", a=frame(), b=frame())
    joints = [
        replace(_joint(JointType.PLANAR, "p", base["a"], part["a"]), rest=(30.0, 0.0, 0.0)),
        declare.revolute("r", base["b"], part["b"], limits=(-1, 1)),
    ]
    assembly = Assembly.from_parts("p", parts=[base, part], joints=joints, ground="base")

    with pytest.raises(UnrepresentableError, match="rests at zero"):
        assembly.to_plan()
