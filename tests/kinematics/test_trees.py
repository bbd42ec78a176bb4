from __future__ import annotations

import math
import subprocess
import sys
from types import MappingProxyType

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings

from articad.connectors import SE3, Mate
from articad.errors import KinematicsError, PlanError
from articad.kinematics import Configuration, Coupling, Joint, JointLimits, JointType, Mechanism, batch, bulk, forward
from tests.kinematics.test_joints import product_of_exponentials
from tests.strategies import posed_trees, random_joint, random_pose, trees

ROUNDING_MM = 1e-14  # times the number of parts and the longest reach in mm
ROUNDING_RAD = 1e-12


def oracle_poses(mechanism: Mechanism, q: np.ndarray) -> dict[str, np.ndarray]:
    """Place every part by products of exponentials over the declared relation, growing from the ground: no tree, no batch."""
    values = Configuration(mechanism.joints, q)
    placed = {mechanism.ground: mechanism.T_ground.matrix}
    F = {Mate.ALIGNED: np.eye(4), Mate.OPPOSED: np.diag([1.0, -1.0, -1.0, 1.0])}
    while len(placed) < len(mechanism.parts):
        for joint in mechanism.joints:
            X = joint.T_parent_connector.matrix @ product_of_exponentials(joint.type, values[joint.name], joint.lead)
            X = X @ F[joint.mate] @ np.linalg.inv(joint.T_child_connector.matrix)
            if joint.parent in placed and joint.child not in placed:
                placed[joint.child] = placed[joint.parent] @ X
            elif joint.child in placed and joint.parent not in placed:
                placed[joint.parent] = placed[joint.child] @ np.linalg.inv(X)
    return placed


@given(posed_trees())
def test_poses_are_the_product_of_exponentials(tree: tuple[Mechanism, np.ndarray]) -> None:
    mechanism, q = tree
    expected = oracle_poses(mechanism, q)
    for part, T in zip(mechanism.parts, mechanism.poses(q), strict=True):
        assert np.abs(T.matrix - expected[part]).max() < 1e-9


@settings(max_examples=150)
@given(posed_trees(max_parts=25))
def test_poses_agree_with_pinocchio_to_rounding(tree: tuple[Mechanism, np.ndarray]) -> None:
    mechanism, q = tree
    ours, theirs = mechanism.arrays.poses(mechanism.layout.normalized(q)), forward.compile(mechanism).poses(q)
    reach = max(1.0, float(np.abs(theirs.translation).max()))
    assert ours.distance_to(theirs).max() < ROUNDING_MM * len(mechanism.parts) * reach
    assert ours.angle_to(theirs).max() < ROUNDING_RAD


@given(trees())
def test_many_configurations_have_the_poses_of_each(mechanism: Mechanism) -> None:
    Q = Configuration.random(mechanism.joints, np.random.default_rng(3), (10, 8)).columns
    assert batch._FEW < 10 * 8  # so that rows are used, not matrices
    together = mechanism.poses(Q)
    assert together.batch_shape == (10, 8, len(mechanism.parts))
    reach = max(1.0, float(np.abs(together.translation).max()))
    for index in ((0, 0), (2, 5), (9, 7)):
        one = mechanism.poses(Q[index])
        assert one.distance_to(together[index]).max() < ROUNDING_MM * len(mechanism.parts) * reach
        assert one.angle_to(together[index]).max() < ROUNDING_RAD
    assert (together.quaternion[..., 3] >= 0).all()
    assert np.abs(np.linalg.norm(together.quaternion, axis=-1) - 1).max() < ROUNDING_RAD
    assert not together.data.flags.writeable


def test_more_configurations_than_one_chunk_are_all_placed() -> None:
    joint = random_joint(np.random.default_rng(0), "j", JointType.SCREW, "a", "b", Mate.OPPOSED)
    mechanism = Mechanism(("a", "b"), "a", [joint])
    q = np.linspace(-2, 3, 9000)[:, None]
    many = mechanism.poses(q)
    for i in (0, 4095, 4096, 8191, 8192, 8999):
        assert many[i].allclose(mechanism.poses(q[i]), mm=1e-11, rad=1e-14)


@pytest.mark.parametrize("shape", ["chain", "star", "comb"])
def test_a_pass_over_rows_keeps_few_frames_at_once(shape: str) -> None:
    comb = [(i - 1 if i % 2 else max(0, i - 2), i) for i in range(1, 100)]
    steps = {"chain": [(i - 1, i) for i in range(1, 100)], "star": [(0, i) for i in range(1, 100)], "comb": comb}[shape]
    slots = bulk._slots(steps, 0)
    assert len(set(slots)) <= 3
    kept = {slots[0]: 0}
    for parent, child in steps:
        assert kept[slots[parent]] == parent  # a frame that is still needed is not overwritten
        assert slots[child] != slots[parent]
        kept[slots[child]] = child


@given(trees())
def test_reversed_declarations_change_nothing(mechanism: Mechanism) -> None:
    q = Configuration.random(mechanism.joints, np.random.default_rng(5)).columns
    turned = [joint.reversed() if joint.type.reversible else joint for joint in mechanism.joints]
    signs = np.concatenate([[]] + [j.type.reversal_signs(j.mate) if j.type.reversible else np.ones(len(j.rest)) for j in mechanism.joints])
    again = Mechanism(mechanism.parts, "p0", turned, T_ground=mechanism.T_ground)
    assert again.poses(signs * q).allclose(mechanism.poses(q), mm=1e-8, rad=1e-12)


@given(posed_trees(max_parts=8))
def test_the_jacobian_is_the_derivative_of_the_poses(tree: tuple[Mechanism, np.ndarray]) -> None:
    mechanism, q = tree
    rng = np.random.default_rng(2)
    index, frame, h = int(rng.integers(len(mechanism.parts))), random_pose(rng), 1e-6
    J = mechanism.jacobian(q, mechanism.parts[index], frame)
    assert J.shape == (6, mechanism.layout.n_freedoms)
    for k in range(mechanism.layout.n_freedoms):
        step = np.zeros(mechanism.layout.n_freedoms)
        step[k] = h
        ahead, behind = (mechanism.poses(mechanism.layout.integrate(q, s * step))[index] @ frame for s in (1, -1))
        v = (ahead.translation - behind.translation) / (2 * h)
        omega = behind.rotation @ (behind.inverse() @ ahead).log()[3:] / (2 * h)
        assert np.abs(J[:, k] - np.concatenate([v, omega])).max() < 1e-4


@given(posed_trees(max_parts=12))
def test_the_jacobian_agrees_with_pinocchio(tree: tuple[Mechanism, np.ndarray]) -> None:
    mechanism, q = tree
    compiled = forward.compile(mechanism)
    rng = np.random.default_rng(4)
    part, frame = mechanism.parts[rng.integers(len(mechanism.parts))], random_pose(rng)
    fid = compiled.model.addFrame(
        pin.Frame(
            "tool",
            compiled.model.frames[compiled.frame_ids[part]].parentJoint,
            compiled.model.frames[compiled.frame_ids[part]].placement * pin.SE3(frame.rotation, frame.translation.copy()),
            pin.FrameType.OP_FRAME,
        )
    )
    data = compiled.model.createData()
    theirs = pin.computeFrameJacobian(compiled.model, data, compiled.q(q), fid, pin.LOCAL_WORLD_ALIGNED).reshape(6, -1)
    ours = mechanism.jacobian(q, part, frame)
    values = Configuration(mechanism.joints, q)
    for c, joint_id in zip(compiled.crossings, compiled.joint_ids, strict=True):
        if not c.joint.type.freedoms:
            continue
        start = compiled.model.joints[joint_id].idx_v
        block = theirs[:, start : start + c.joint.type.freedoms]
        mine = ours[:, mechanism.layout.freedoms[c.joint.name]]
        # Pinocchio's spin of ball and free joints is in the moving frame; ours is in the parent connector's
        if c.joint.type is JointType.BALL:
            R = c.joint.motion(values[c.joint.name]).rotation
            backwards = c.signs[0] < 0
            block = block @ (-np.eye(3) if backwards else R.T)
        elif c.joint.type is JointType.FREE:
            R = c.joint.motion(values[c.joint.name]).rotation
            block = np.hstack([block[:, :3], block[:, 3:] @ R.T])
        else:
            block = block * c.signs
        assert np.abs(block - mine).max() < 1e-9 * max(1.0, np.abs(mine).max())


def test_the_ball_jacobian_is_in_the_parent_connectors_frame() -> None:
    ball = random_joint(np.random.default_rng(8), "ball", JointType.BALL, "a", "b", Mate.ALIGNED)
    mechanism = Mechanism(("a", "b"), "a", [ball])
    q = SE3.rot_x(0.4).quaternion
    assert np.allclose(mechanism.jacobian(q, "b")[3:], ball.T_parent_connector.rotation, atol=1e-14)


def test_rest_names_and_counts_of_a_tree() -> None:
    rng = np.random.default_rng(1)
    joints = [random_joint(rng, f"j{i}", t, f"p{i}", f"p{i + 1}", Mate.ALIGNED) for i, t in enumerate(JointType)]
    mechanism = Mechanism([f"p{i}" for i in range(10)], "p0", joints)
    assert mechanism.nq == len(mechanism.drivers) == len(mechanism.coordinates) == 21
    assert mechanism.mobility == mechanism.grubler == 19
    assert mechanism.driving_joints == tuple(joint.name for joint in joints if joint.type not in {JointType.FIXED, JointType.FREE})
    assert mechanism.is_tree
    assert len(mechanism.findings()) == 0
    assert mechanism.rest.tolist() == [value for joint in joints for value in joint.rest]
    assert mechanism.configuration(mechanism.rest).values == Configuration.rest(joints).values
    np.testing.assert_allclose(mechanism.rest_poses()["p8"].matrix, mechanism.poses(mechanism.rest)[8].matrix, rtol=0, atol=1e-12)
    assert repr(mechanism) == "Mechanism(10 parts, 9 joints, 0 loops)"
    assert isinstance(mechanism.configuration(mechanism.rest).values, MappingProxyType)


def test_a_part_alone_is_a_mechanism() -> None:
    alone = Mechanism(("only",), "only", [], T_ground=SE3.trans(1, 2, 3))
    assert alone.poses([])[0] == SE3.trans(1, 2, 3)
    assert alone.poses(np.zeros((50, 0))).batch_shape == (50, 1)
    assert alone.mobility == 0
    assert alone.jacobian([], "only").shape == (6, 0)


@pytest.mark.parametrize(
    ("q", "text"),
    [
        ([1.0, 2.0], "its last axis must have 5 columns: j, ball.qx"),
        (1.0, "has shape ()"),
        ([math.nan, 0, 0, 0, 1], "E_NONFINITE"),
        ([0, 0, 0, 0, 2.0], "E_QUAT_NORM: joint 'ball'"),
    ],
)
def test_wrong_coordinates_are_refused_before_any_arithmetic(q: object, text: str) -> None:
    rng = np.random.default_rng(1)
    joints = [
        random_joint(rng, "j", JointType.REVOLUTE, "a", "b", Mate.ALIGNED),
        random_joint(rng, "ball", JointType.BALL, "b", "c", Mate.ALIGNED),
    ]
    mechanism = Mechanism(("a", "b", "c"), "a", joints)
    with pytest.raises(KinematicsError) as caught:
        mechanism.poses(q)  # type: ignore[arg-type]
    assert text in str(caught.value)
    with pytest.raises(KinematicsError, match=r"Unknown part 'd'.*Known: a, b, c"):
        mechanism.jacobian(mechanism.rest, "d")


def test_a_mechanism_is_refused_with_all_its_findings() -> None:
    bad = Joint(**{**random_joint(np.random.default_rng(0), "j", JointType.SLIDER, "a", "b", Mate.ALIGNED).__dict__, "rest": (999.0,)})
    couplings = [
        Coupling("c1", "gear", "j", "nowhere", -1.0),
        Coupling("c2", "gear", "j", "j", 0.0),
    ]
    with pytest.raises(PlanError) as caught:
        Mechanism(("a", "b", "c"), "a", [bad], couplings)
    assert set(caught.value.findings.codes) == {
        "E_REST_OUTSIDE_LIMITS",
        "E_DISCONNECTED",
        "E_JOINT_UNKNOWN",
        "E_COUPLING",
        "E_COUPLING_RATIO",
    }
    ball = random_joint(np.random.default_rng(0), "ball", JointType.BALL, "a", "b", Mate.ALIGNED)
    with pytest.raises(PlanError, match="component of ball"):
        Mechanism(("a", "b"), "a", [ball], [Coupling("c", "gear", "ball.qx", "ball.qy", 1.0)])


def test_pinocchio_data_is_refused_before_it_fills_the_memory() -> None:
    joints = [random_joint(np.random.default_rng(i), f"j{i}", JointType.BALL, f"p{i}", f"p{i + 1}", Mate.ALIGNED) for i in range(90)]
    compiled = forward.compile(Mechanism([f"p{i}" for i in range(91)], "p0", joints))
    with pytest.raises(KinematicsError, match=r"270 freedoms takes about 1.2 GiB.*batch"):
        compiled.data  # noqa: B018


def test_a_compiled_model_refuses_what_is_no_configuration_and_forgives_the_digits_of_a_file() -> None:
    rng = np.random.default_rng(0)
    kinds = (JointType.BALL, JointType.BALL, JointType.PLANAR)
    joints = [random_joint(rng, f"j{i}", kind, f"p{i}", f"p{i + 1}", Mate.ALIGNED) for i, kind in enumerate(kinds)]
    mechanism = Mechanism(("p0", "p1", "p2", "p3"), "p0", joints)
    compiled = forward.compile(mechanism)
    rough = mechanism.rest.copy()
    rough[[3, 7]] = 1 + 9e-4  # each passes, though together they are off by more than one may be
    assert compiled.poses(rough).allclose(mechanism.poses(rough))
    for column, value, code in (
        (0, np.nan, "E_NONFINITE"),
        (8, np.inf, "E_NONFINITE"),
        (10, np.nan, "E_NONFINITE"),
        (3, 1.01, "E_QUAT_NORM"),
    ):
        wrong = mechanism.rest.copy()
        wrong[column] = value
        with pytest.raises(KinematicsError, match=code):
            compiled.poses(wrong)


def test_the_mass_matrix_is_right_because_joints_are_numbered_depth_first() -> None:
    # a Y declared breadth-first: Pinocchio's crba would be silently wrong if the joints were added in that order
    rng = np.random.default_rng(0)
    ends = [("g", "a"), ("a", "b"), ("a", "c"), ("b", "d"), ("c", "e")]
    joints = [random_joint(rng, f"j{i}", JointType.REVOLUTE, p, c, Mate.ALIGNED) for i, (p, c) in enumerate(ends)]
    model = forward.compile(Mechanism(("g", "a", "b", "c", "d", "e"), "g", joints)).model
    for i in range(1, model.njoints):
        model.inertias[i] = pin.Inertia(1.0, np.array([0.1, 0.2, 0.3]), np.eye(3))
    q, data = np.full(model.nq, 0.3), model.createData()
    M = np.triu(pin.crba(model, data, q))
    columns = [
        pin.rnea(model, data, q, np.zeros(model.nv), e) - pin.rnea(model, data, q, np.zeros(model.nv), 0 * e) for e in np.eye(model.nv)
    ]
    assert np.abs(M - np.triu(np.array(columns).T)).max() < 1e-6 * np.abs(M).max()


def test_importing_kinematics_loads_numpy_and_nothing_heavy() -> None:
    heavy = "{'pinocchio', 'scipy', 'pydantic', 'trimesh', 'fcl', 'mujoco', 'litellm', 'build123d'}"
    script = f"import sys, articad.kinematics; print(sorted({heavy} & {{m.split('.')[0] for m in sys.modules}}))"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def test_limits_of_a_joint_may_be_endless() -> None:
    spinner = Joint(
        **{
            **random_joint(np.random.default_rng(0), "j", JointType.REVOLUTE, "a", "b", Mate.ALIGNED).__dict__,
            "limits": JointLimits((-math.inf,), (math.inf,)),
        }
    )
    mechanism = Mechanism(("a", "b"), "a", [spinner])
    assert mechanism.poses([1.0]).allclose(mechanism.poses([1.0 + 200 * math.pi]), mm=1e-9, rad=1e-12)
