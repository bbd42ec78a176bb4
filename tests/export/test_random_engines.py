"""Random mechanisms as MuJoCo and Pinocchio see them: the exports at our joint values are where the test's own equations say."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors import Connector
from articad.export.features import rigid_with_ground
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.part import Part
from articad.kinematics import Mechanism
from tests.engines import MujocoMjcf, PinocchioUrdf, ball_values, free_values, joint_values, our_poses
from tests.pose_equations import Solution
from tests.random_ways import Case, Way, case_of, seeds

FloatArray = NDArray[np.float64]
Engine = Callable[[FloatArray], Mapping[str, FloatArray]]

pytestmark = pytest.mark.engines
ROUNDING = 1e-9  # per size and condition: by which poses may differ


def bare(mechanism: Mechanism) -> Assembly:
    """Return an assembly of parts without geometry."""
    connectors: dict[str, dict[str, Connector]] = {name: {} for name in mechanism.parts}
    for j in mechanism.joints:
        connectors[j.parent][j.parent_connector] = Connector(j.parent_connector, j.T_parent_connector)
        connectors[j.child][j.child_connector] = Connector(j.child_connector, j.T_child_connector)
    parts = [Part.without_geometry(name, own) for name, own in connectors.items()]
    return Assembly.from_parts(
        "random", parts=parts, joints=mechanism.joints, ground=mechanism.ground, couplings=mechanism.couplings, T_ground=mechanism.T_ground
    )


@pytest.mark.parametrize("seed", seeds())
def test_mujoco_places_every_part_where_the_equations_do(seed: int, tmp_path: Path) -> None:
    case = case_of(seed)
    assembly, bundle = bare(case.mechanism), write_mjcf(bare(case.mechanism))
    bundle.write(tmp_path)
    engine = MujocoMjcf(tmp_path / bundle.main)
    engine.origins = dict.fromkeys(case.mechanism.parts, np.eye(4))
    frames, at_home, at_rest = engine.free_frames(), engine.home(), our_poses(assembly, case.mechanism.rest)
    still = rigid_with_ground(assembly)
    nested = {joint.name: joint.child for joint in assembly.joints if joint.name in frames and joint.parent not in still}

    def poses(q: FloatArray) -> Mapping[str, FloatArray]:
        free = {name: frames[name] @ T for name, T in free_values(assembly, q).items() if name in frames}
        for name, part in nested.items():  # MuJoCo has no such joint: its body is placed in the world, as the part is
            free[name] = our_poses(assembly, q)[part] @ np.linalg.inv(at_rest[part]) @ at_home[part]
        return engine.poses(joint_values(assembly, q), ball_values(assembly, q), free)

    for way, at in assert_agree(case, poses):
        engine.mujoco.mj_forward(engine.model, engine.data)
        equalities = engine.data.efc_type == engine.mujoco.mjtConstraint.mjCNSTR_EQUALITY
        assert np.abs(engine.data.efc_pos[equalities]).max(initial=0.0) < tolerance(case, at) * max(1.0, large(case)), way.drivers


@pytest.mark.parametrize("seed", seeds())
def test_pinocchio_places_every_part_where_the_equations_do(seed: int, tmp_path: Path) -> None:
    """A URDF has no loops: of these the joints of the tree are set."""
    case = case_of(seed)
    assembly, bundle = bare(case.mechanism), write_urdf(bare(case.mechanism))
    bundle.write(tmp_path)
    engine = PinocchioUrdf(tmp_path / bundle.main)
    engine.origins = dict.fromkeys(case.mechanism.parts, np.eye(4))
    known = set(engine.model.names)

    def poses(q: FloatArray) -> Mapping[str, FloatArray]:
        values, free = joint_values(assembly, q), free_values(assembly, q)
        return engine.poses(
            {name: v for name, v in values.items() if name in known}, {name: T for name, T in free.items() if name in known}
        )

    for _ in assert_agree(case, poses):
        pass


def assert_agree(case: Case, poses: Engine) -> Iterator[tuple[Way, Solution]]:
    """The engine's bodies move from rest [m] as the parts do, whatever frames they have; yield the displacements at each pose."""
    at_rest = poses(case.mechanism.rest)
    frames = {name: np.linalg.inv(T) @ metres(case.specimen.rest[name]) for name, T in at_rest.items()}
    for way in case.ways:
        for at in way.solutions[-1:]:
            theirs = poses(case.q(at))
            for name, truth in zip(case.mechanism.parts, at.X, strict=True):
                apart = np.abs(theirs[name] @ frames[name] - metres(truth))
                assert apart[:3, :3].max() < tolerance(case, at), (name, way.drivers, case.specimen.story)
                assert apart[:3, 3].max() < tolerance(case, at) * large(case), (name, way.drivers, case.specimen.story)
            yield way, at


def tolerance(case: Case, at: Solution) -> float:
    return ROUNDING / min(1.0, at.sigma)


def large(case: Case) -> float:
    """Return how far parts are from the origin [m]."""
    return float(np.abs(case.equations.rest.X[:, :3, 3]).max() + case.equations.L_part.max()) / 1000


def metres(T: FloatArray) -> FloatArray:
    out = T.copy()
    out[:3, 3] /= 1000
    return out
