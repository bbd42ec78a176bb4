from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.connectors import FLIP, SE3, Mate, child_pose, flip
from articad.errors import ConnectorError, KinematicsError
from articad.kinematics import Configuration, Joint, JointLimits, JointType
from articad.kinematics.joints import swing, twist, wrapped
from tests.strategies import joint_types, joints, mates, random_joint

reversible = st.sampled_from([t for t in JointType if t.reversible])
seeds = st.integers(0, 2**32 - 1)
K = np.diag([1.0, -1.0, 1.0, 1.0])


def drawn(joint: Joint, seed: int) -> np.ndarray:
    return Configuration.random([joint], np.random.default_rng(seed)).columns


def placed(joint: Joint, q: np.ndarray) -> SE3:
    return child_pose(SE3.identity(), joint.T_parent_connector, joint.motion(q), joint.mate, joint.T_child_connector)


def product_of_exponentials(joint_type: JointType, q: np.ndarray, lead: float) -> np.ndarray:
    """J(q) by Pinocchio's exponentials of unit twists [v; ω]: an oracle that shares nothing with ours."""
    e = np.eye(6)
    match joint_type:
        case JointType.FIXED:
            return np.eye(4)
        case JointType.REVOLUTE:
            factors = [q[0] * e[5]]
        case JointType.SLIDER:
            factors = [q[0] * e[2]]
        case JointType.CYLINDRICAL:
            factors = [q[0] * e[2], q[1] * e[5]]
        case JointType.SCREW:
            factors = [q[0] * (e[5] + lead / (2 * math.pi) * e[2])]
        case JointType.PLANAR:
            factors = [q[0] * e[0], q[1] * e[1], q[2] * e[5]]
        case JointType.UNIVERSAL:
            factors = [q[0] * e[3], q[1] * e[4]]
        case JointType.FREE:
            turned = pin.log3(pin.Quaternion(q[6], q[3], q[4], q[5]).matrix())
            factors = [q[0] * e[0] + q[1] * e[1] + q[2] * e[2], np.concatenate([np.zeros(3), turned])]
        case _:
            factors = [np.concatenate([np.zeros(3), pin.log3(pin.Quaternion(q[3], q[0], q[1], q[2]).matrix())])]
    M = np.eye(4)
    for xi in factors:
        M = M @ pin.exp6(xi).homogeneous
    return M


@given(joints(), seeds)
def test_motion_is_the_product_of_its_exponentials(joint: Joint, seed: int) -> None:
    q = drawn(joint, seed)
    assert np.abs(joint.motion(q).matrix - product_of_exponentials(joint.type, q, joint.lead)).max() < 1e-12


@pytest.mark.parametrize("joint_type", JointType)
def test_the_neutral_motion_is_the_identity_and_names_units_and_freedoms_fit(joint_type: JointType) -> None:
    assert joint_type.motion(joint_type.neutral, lead=5.0) == SE3.identity()
    assert len(joint_type.coordinates) == len(joint_type.units)
    assert len(joint_type.freedom_units) == joint_type.freedoms
    expected = {"fixed": 0, "revolute": 1, "slider": 1, "cylindrical": 2, "ball": 3, "screw": 1, "planar": 3, "universal": 2, "free": 6}
    assert joint_type.freedoms == expected[joint_type]


def test_a_right_handed_screw_advances_by_its_lead_in_one_turn() -> None:
    turned = JointType.SCREW.motion([2 * math.pi], lead=5.0)
    assert turned.allclose(SE3.trans(0, 0, 5), mm=1e-14, rad=1e-15)


@pytest.mark.parametrize("joint_type", JointType)
def test_motion_takes_batches_and_refuses_other_shapes(joint_type: JointType) -> None:
    n = len(joint_type.coordinates)
    q = np.tile(joint_type.neutral, (3, 2, 1)).reshape(3, 2, n)
    assert joint_type.motion(q).batch_shape == (3, 2)
    with pytest.raises(KinematicsError, match="coordinates"):
        joint_type.motion(np.zeros(n + 1))
    with pytest.raises(KinematicsError, match="coordinates"):
        joint_type.motion(1.0)


def test_a_quaternion_far_from_unit_length_is_refused() -> None:
    with pytest.raises(ConnectorError, match="E_QUAT_NORM"):
        JointType.BALL.motion((0, 0, 0, 2.0))


# --- reversal


@given(joints(reversible), seeds)
def test_a_reversed_joint_places_the_parts_alike(joint: Joint, seed: int) -> None:
    q = drawn(joint, seed)
    back = joint.reversed()
    q_back = joint.type.reversal_signs(joint.mate) * q
    assert placed(back, q_back).inverse().allclose(placed(joint, q), mm=1e-10, rad=1e-13)
    assert Configuration((back,), q_back).violations() == ()  # limits go along
    assert (back.parent, back.child, back.parent_connector) == ("b", "a", joint.child_connector)
    assert back.reversed() == joint


@given(joints(reversible))
def test_reversal_signs_are_those_of_the_inverse_motion(joint: Joint) -> None:
    q = drawn(joint, 7)
    F = flip(joint.mate)
    reversed_motion = joint.motion(joint.type.reversal_signs(joint.mate) * q)
    assert reversed_motion.allclose(F @ joint.motion(q).inverse() @ F, mm=1e-11, rad=1e-13)


def test_opposed_is_symmetric_and_aligned_is_antisymmetric() -> None:
    rng = np.random.default_rng(0)
    aligned = random_joint(rng, "j", JointType.REVOLUTE, "a", "b", Mate.ALIGNED)
    opposed = random_joint(rng, "j", JointType.REVOLUTE, "a", "b", Mate.OPPOSED)
    assert (aligned.reversed().limits.lower, aligned.reversed().limits.upper) == ((-3.0,), (2.0,))
    assert opposed.reversed().limits == opposed.limits


@pytest.mark.parametrize(("mate", "expected"), [(Mate.ALIGNED, (-0.2, 0.7)), (Mate.OPPOSED, (-0.7, 0.2))])
def test_a_reversed_ball_keeps_its_cone_and_turns_its_twist_where_aligned(mate: Mate, expected: tuple[float, float]) -> None:
    ball = random_joint(np.random.default_rng(0), "j", JointType.BALL, "a", "b", mate)
    ball = Joint(**{**ball.__dict__, "limits": JointLimits(cone=1.0, twist=(-0.7, 0.2))})
    assert ball.reversed().limits == JointLimits(cone=1.0, twist=expected)


@pytest.mark.parametrize("joint_type", [JointType.PLANAR, JointType.UNIVERSAL, JointType.FREE])
def test_planar_and_universal_refuse_reversal(joint_type: JointType) -> None:
    joint = random_joint(np.random.default_rng(0), "j", joint_type, "a", "b", Mate.ALIGNED)
    with pytest.raises(KinematicsError, match="E_REVERSE_UNSUPPORTED"):
        joint.reversed()


def test_an_opposed_joint_measured_either_side_of_the_flip_changes_sign() -> None:
    for joint_type in (JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL, JointType.SCREW):
        q = np.full(len(joint_type.coordinates), 0.7)
        assert (FLIP @ joint_type.motion(q, 3.0)).allclose(joint_type.motion(-q, 3.0) @ FLIP, mm=1e-15, rad=1e-15)


# --- mirror


@given(joints(), seeds)
def test_mirror_signs_conjugate_the_motion_by_k(joint: Joint, seed: int) -> None:
    q = drawn(joint, seed)
    image = joint.mirrored(
        name="image",
        parent="c",
        child="d",
        parent_connector="x",
        child_connector="y",
        T_parent_connector=SE3.identity(),
        T_child_connector=SE3.identity(),
    )
    q_image = joint.type.mirror_signs() * q
    assert np.abs(image.motion(q_image).matrix - K @ joint.motion(q).matrix @ K).max() < 1e-12
    assert Configuration((image,), q_image).violations() == ()
    assert (image.name, image.parent, image.child, image.mate, image.driver) == ("image", "c", "d", joint.mate, False)


@given(joint_types, mates, seeds)
def test_the_image_of_a_mated_part_is_the_mated_image(joint_type: JointType, mate: Mate, seed: int) -> None:
    # T_c' S_c = S_w T_c for any world plane and any plane in the child's frame
    rng = np.random.default_rng(seed)
    joint = random_joint(rng, "j", joint_type, "a", "b", mate)

    def reflection() -> np.ndarray:
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        S = np.eye(4)
        S[:3, :3] -= 2 * np.outer(n, n)
        S[:3, 3] = rng.normal(size=3) * 100
        S[:3, 3] = 2 * (S[:3, 3] @ n) * n
        return S

    S_w, S_c = reflection(), reflection()
    image = joint.mirrored(
        name="image",
        parent="a",
        child="c",
        parent_connector="p",
        child_connector="c",
        T_parent_connector=SE3.from_matrix(S_w @ joint.T_parent_connector.matrix @ K),
        T_child_connector=SE3.from_matrix(S_c @ joint.T_child_connector.matrix @ K),
    )
    q = drawn(joint, seed)
    left = placed(image, joint.type.mirror_signs() * q).matrix @ S_c
    assert np.abs(left - S_w @ placed(joint, q).matrix).max() < 1e-10


def test_a_mirrored_door_opens_to_the_other_side() -> None:
    left = Joint(
        name="left",
        type=JointType.REVOLUTE,
        parent="cabinet",
        child="door",
        parent_connector="h",
        child_connector="h",
        T_parent_connector=SE3.trans(-450, 0, 0),
        T_child_connector=SE3.identity(),
        limits=JointLimits((-1.9,), (0.0,)),
        rest=(0.0,),
    )
    right = left.mirrored(
        name="right",
        parent="cabinet",
        child="door_right",
        parent_connector="h2",
        child_connector="h",
        T_parent_connector=SE3.trans(450, 0, 0) @ SE3.rot_z(math.pi),
        T_child_connector=SE3.rot_z(math.pi),
    )
    assert right.limits == JointLimits((-0.0,), (1.9,))
    # handle at (400, -10, 550) of the left door; kinematics: reference values, at -60° and +60°
    handle = placed(left, np.array([math.radians(-60)])).apply((428.038475772934, -10 - 0, 550))
    image = placed(right, np.array([math.radians(60)])).apply((-428.038475772934, -10, 550))
    assert np.allclose(handle * (-1, 1, 1), image, rtol=0, atol=1e-12)


def test_a_mirrored_screw_changes_hand() -> None:
    screw = random_joint(np.random.default_rng(0), "j", JointType.SCREW, "a", "b", Mate.ALIGNED)
    image = screw.mirrored(
        name="i",
        parent="a",
        child="c",
        parent_connector="p",
        child_connector="c",
        T_parent_connector=SE3.identity(),
        T_child_connector=SE3.identity(),
    )
    assert image.lead == -screw.lead
    assert image.motion([-1.0]).translation[2] == screw.motion([1.0]).translation[2]


# --- swing, twist, names, columns


@given(st.floats(-3.1, 3.1), st.floats(0, 3.1), st.floats(-3.1, 3.1))
def test_swing_is_the_angle_of_the_z_axes_and_twist_what_is_left(direction: float, tilt: float, turn: float) -> None:
    T = SE3.rot_z(direction) @ SE3.rot_y(tilt) @ SE3.rot_z(-direction) @ SE3.rot_z(turn)
    assert swing(T.quaternion) == pytest.approx(math.acos(min(1, max(-1, T.rotation[2, 2]))), abs=1e-7)
    assert swing(T.quaternion) == pytest.approx(tilt, abs=1e-12)
    assert twist(T.quaternion) == pytest.approx(turn, abs=1e-12)
    assert twist(-T.quaternion) == pytest.approx(turn, abs=1e-12)


def test_wrapped_angles_lie_in_a_half_open_turn() -> None:
    assert np.allclose(wrapped([3.5, -3.5, 7.0, math.pi]), [3.5 - 2 * math.pi, 2 * math.pi - 3.5, 7.0 - 2 * math.pi, -math.pi])


def test_columns_bear_the_joints_name_and_the_coordinates_where_there_are_several() -> None:
    rng = np.random.default_rng(0)
    rod = random_joint(rng, "rod", JointType.CYLINDRICAL, "a", "b", Mate.ALIGNED)
    assert rod.column_names == ("rod.travel", "rod.angle")
    assert [(c.unit, c.lower, c.upper, c.rest) for c in rod.columns] == [("mm", -80, 120, 0), ("rad", -2, 3, 0)]
    assert random_joint(rng, "elbow", JointType.REVOLUTE, "a", "b", Mate.ALIGNED).column_names == ("elbow",)
    ball = random_joint(rng, "ball", JointType.BALL, "a", "b", Mate.ALIGNED)
    assert [(c.name, c.unit, c.lower, c.upper) for c in ball.columns][3] == ("ball.qw", "1", -1, 1)


# --- findings


def joint_with(joint_type: JointType, **changes: object) -> Joint:
    joint = random_joint(np.random.default_rng(0), "j", joint_type, "a", "b", Mate.ALIGNED)
    return Joint(**{**joint.__dict__, **changes})


@pytest.mark.parametrize(
    ("joint", "code", "text"),
    [
        (joint_with(JointType.REVOLUTE, limits=JointLimits((math.radians(90),), (0.0,))), "E_LIMITS_ORDER", "Did you mean [0°, 90°]?"),
        (joint_with(JointType.SLIDER, rest=(500.0,)), "E_REST_OUTSIDE_LIMITS", "rests at 500 mm, outside [-80 mm, 120 mm]"),
        (joint_with(JointType.SLIDER, rest=(math.nan,)), "E_NONFINITE", "must be finite"),
        (joint_with(JointType.SLIDER, limits=JointLimits((math.nan,), (1.0,))), "E_NONFINITE", "not numbers"),
        (joint_with(JointType.SCREW, lead=0.0), "E_LEAD_ZERO", "revolute"),
        (joint_with(JointType.SLIDER, limits=JointLimits()), "E_LIMITS_KIND", "1 pair(s)"),
        (joint_with(JointType.SLIDER, rest=(1.0, 2.0)), "E_LIMITS_KIND", "1 rest value(s), not 2"),
        (joint_with(JointType.BALL, limits=JointLimits((0.0,), (1.0,))), "E_LIMITS_KIND", "cone"),
        (joint_with(JointType.BALL, limits=JointLimits(cone=-0.1)), "E_LIMITS_ORDER", "cone"),
        (joint_with(JointType.BALL, limits=JointLimits(cone=1.0, twist=(1.0, -1.0))), "E_LIMITS_ORDER", "twist"),
        (joint_with(JointType.BALL, limits=JointLimits(cone=1.0, twist=(0.5, 1.0))), "E_REST_OUTSIDE_LIMITS", "cone or twist"),
        (joint_with(JointType.BALL, rest=(0.0, 0.0, 0.0, 2.0)), "E_QUAT_NORM", "unit length"),
        (joint_with(JointType.FIXED, driver=True), "W_DRIVER", "cannot drive"),
    ],
)
def test_each_wrong_number_of_a_joint_has_its_finding(joint: Joint, code: str, text: str) -> None:
    findings = joint.findings()
    assert code in [finding.code for finding in findings]
    assert any(text in str(finding) for finding in findings)


@given(joints())
def test_drawn_joints_have_no_findings(joint: Joint) -> None:
    assert joint.findings() == []
    assert joint_with(JointType.BALL, limits=JointLimits()).findings() == []
