"""Hypothesis strategies of the whole suite. A new kind of value joins here, so that every law meets it."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from articad.connectors import SE3, Connector, Mate
from articad.kinematics import Configuration, Joint, JointLimits, JointType, Mechanism

REACH = 500.0  # mm: translations drawn are at most this long per axis

lengths = st.floats(-REACH, REACH, allow_nan=False)
angles = st.floats(-math.pi, math.pi, allow_nan=False)
mates = st.sampled_from(Mate)
joint_types = st.sampled_from(JointType)
vectors = st.tuples(lengths, lengths, lengths).map(np.array)


@st.composite
def directions(draw: st.DrawFn) -> np.ndarray:
    """Unit vectors, evenly over the sphere, the world's axes among them."""
    if draw(st.booleans()):
        axis: np.ndarray = np.eye(3)[draw(st.integers(0, 2))] * draw(st.sampled_from([-1.0, 1.0]))
        return axis
    height, turn = draw(st.floats(-1, 1)), draw(angles)
    radius = math.sqrt(1 - height * height)
    return np.array([radius * math.cos(turn), radius * math.sin(turn), height])


@st.composite
def rotation_vectors(draw: st.DrawFn) -> np.ndarray:
    """Rotation vectors of 0 … π, with emphasis on the neighbourhoods of 0 and π."""
    size = draw(
        st.one_of(
            st.floats(0, math.pi),
            st.sampled_from([0.0, 1e-300, 1e-16, 1e-9, 1e-8, 1e-5, 1e-3, 0.24999, 0.25001]),
            st.sampled_from([1e-15, 1e-12, 1e-9, 1e-8, 1e-5, 1e-3]).map(lambda gap: math.pi - gap),
        )
    )
    return size * draw(directions())


@st.composite
def poses(draw: st.DrawFn) -> SE3:
    """Single rigid motions."""
    return SE3.exp(np.concatenate([draw(vectors), draw(rotation_vectors())]))


@st.composite
def connectors(draw: st.DrawFn) -> Connector:
    """Connectors at any frame."""
    return Connector(draw(st.sampled_from(["hinge", "slide", "tip"])), draw(poses()), kind=draw(st.sampled_from(["frame", "shaft_axis"])))


def limits_of(joint_type: JointType, rng: np.random.Generator) -> JointLimits:
    """Return limits around zero, of every kind the type may have."""
    if joint_type is JointType.BALL:
        return JointLimits(cone=float(rng.uniform(0.2, 2.5)), twist=None if rng.random() < 0.3 else (-0.7, float(rng.uniform(0.1, 3))))
    if joint_type is JointType.FREE:
        return JointLimits()
    spans = [(-2.0, 3.0) if unit == "rad" else (-80.0, 120.0) for unit in joint_type.units]
    return JointLimits(lower=tuple(lo for lo, _ in spans), upper=tuple(hi for _, hi in spans))


def random_pose(rng: np.random.Generator, reach: float = 200.0) -> SE3:
    """Return a pose at any orientation."""
    return SE3.exp(np.concatenate([rng.uniform(-reach, reach, 3), rng.normal(size=3) * 1.5]))


def random_joint(rng: np.random.Generator, name: str, joint_type: JointType, parent: str, child: str, mate: Mate) -> Joint:
    """Return a joint between connectors at random frames."""
    return Joint(
        name=name,
        type=joint_type,
        parent=parent,
        child=child,
        parent_connector=f"{name}_on_{parent}",
        child_connector=f"{name}_on_{child}",
        T_parent_connector=random_pose(rng),
        T_child_connector=random_pose(rng),
        mate=mate,
        limits=limits_of(joint_type, rng),
        rest=joint_type.neutral,
        lead=float(rng.uniform(-20, 20)) if joint_type is JointType.SCREW else 0.0,
    )


@st.composite
def joints(draw: st.DrawFn, types: st.SearchStrategy[JointType] = joint_types) -> Joint:
    """Single joints from part "a" to part "b"."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return random_joint(rng, "joint", draw(types), "a", "b", draw(mates))


@st.composite
def trees(draw: st.DrawFn, max_parts: int = 12) -> Mechanism:
    """Mechanisms without loops: any shape, all types, both mates, joints declared either way, in any order."""
    n = draw(st.integers(1, max_parts))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    declared = []
    for i in range(1, n):
        joint_type, near, far = draw(joint_types), f"p{draw(st.integers(0, i - 1))}", f"p{i}"
        if joint_type.reversible and draw(st.booleans()):
            near, far = far, near
        declared.append(random_joint(rng, f"j{i}", joint_type, near, far, draw(mates)))
    order = rng.permutation(max(0, n - 1))
    parts = [f"p{i}" for i in rng.permutation(n)]
    return Mechanism(parts, "p0", [declared[i] for i in order], T_ground=random_pose(rng))


@st.composite
def posed_trees(draw: st.DrawFn, max_parts: int = 12) -> tuple[Mechanism, np.ndarray]:
    """Trees with one configuration `(nq,)` within the limits."""
    tree = draw(trees(max_parts))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return tree, Configuration.random(tree.joints, rng).columns
