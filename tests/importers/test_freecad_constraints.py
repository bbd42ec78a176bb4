"""FreeCAD's joints that restrict others: which joint they make together, against the motions that were put in."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box
from articad.importers.freecad_constraints import Constraint, merged, planar_faces
from articad.kinematics.joints import Joint, JointLimits, JointType

POSES = {"a": SE3.from_axis_angle([1.0, 2.0, -1.0], 0.7), "b": SE3.from_axis_angle([0.3, -1.0, 0.5], 1.9, about=[40.0, -25.0, 60.0])}
ENDLESS = {JointType.CYLINDRICAL: 2, JointType.REVOLUTE: 1, JointType.SLIDER: 1}


def at(T: SE3) -> tuple[SE3, SE3]:
    """Return a frame of the world in both parts."""
    return POSES["a"].inverse() @ T, POSES["b"].inverse() @ T


def frame(seed: int) -> SE3:
    rng = np.random.default_rng(seed)
    return SE3.from_axis_angle(rng.normal(size=3), float(rng.uniform(0.2, 3.0)), about=rng.uniform(-80, 80, size=3))


def constraint(kind: str, one: SE3, other: SE3, value: float = 0.0, *, points: bool = False, back: bool = False) -> Constraint:
    near, far = at(one)[0], at(other)[1]
    if back:
        near, far = at(one)[1], at(other)[0]
    return Constraint(kind.lower(), kind, ("b", "a") if back else ("a", "b"), ("one", "other"), (near, far), value, points)


def joint(kind: JointType, T: SE3, rest: tuple[float, ...] = (), *, back: bool = False) -> Joint:
    """Return a joint whose frames meet at `T` after its rest motion."""
    near, far = at(T)
    near = near @ kind.motion(rest).inverse() if rest else near
    limits = JointLimits(
        tuple(-10.0 * (place + 1) for place in range(ENDLESS.get(kind, 0))),
        tuple(5.0 * (place + 1) for place in range(ENDLESS.get(kind, 0))),
    )
    made = Joint(
        name="j",
        type=kind,
        parent="a",
        child="b",
        parent_connector="near",
        child_connector="far",
        T_parent_connector=near,
        T_child_connector=far,
        limits=limits,
        rest=rest or ((0.0, 0.0, 0.0, 1.0) if kind is JointType.BALL else ()),
    )
    return made.reversed() if back else made


def read(joints: list[Joint], *constraints: Constraint) -> Joint:
    found = merged(joints, constraints, POSES)
    assert isinstance(found, list), found
    (one,) = found
    T = POSES["a"].inverse() @ POSES["b"]
    T = T if one.parent == "a" else T.inverse()
    assert (one.T_parent_connector @ one.type.motion(one.rest, one.lead) @ one.T_child_connector.inverse()).allclose(T, mm=1e-6, rad=1e-9)
    return one


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_a_restriction_beside_a_joint_makes_the_joint_that_is_left(seed: int, back: bool) -> None:
    T = frame(seed)
    turned = T @ SE3.rot_x(math.pi / 2)
    cylindrical = joint(JointType.CYLINDRICAL, T, (3.0, 0.4), back=back)
    hinge = read([cylindrical], constraint("Distance", T, T @ SE3.trans(0.0, 0.0, 7.0), 7.0, back=back))
    assert (hinge.type, hinge.limits.upper) == (JointType.REVOLUTE, cylindrical.limits.upper[1:])
    slide = read([cylindrical], constraint("Parallel", turned, turned))
    assert (slide.type, slide.limits.upper) == (JointType.SLIDER, cylindrical.limits.upper[:1])
    assert (
        read([joint(JointType.REVOLUTE, T, (0.2,), back=back)], constraint("Angle", turned, turned @ SE3.rot_y(0.6), 0.6)).type
        is JointType.FIXED
    )
    assert read([joint(JointType.SLIDER, T, (2.0,))], constraint("Distance", T, T, back=back)).type is JointType.FIXED
    slider = joint(JointType.SLIDER, T, (2.0,), back=back)
    assert read([slider], constraint("Parallel", T, T)) == slider  # what a slider keeps anyway
    universal = read([joint(JointType.BALL, T)], constraint("Perpendicular", turned, T, back=back))
    assert universal.type is JointType.UNIVERSAL
    x = (
        universal.T_parent_connector.rotation[:, 0]
        if universal.parent == "a"
        else (POSES["a"].inverse() @ POSES["b"]).rotation @ universal.T_parent_connector.rotation[:, 0]
    )
    axes = [(POSES["a"].inverse() @ frame_of).rotation[:, 2] for frame_of in (turned, T)]
    assert max(abs(float(x @ axis)) for axis in axes) == pytest.approx(1.0, abs=1e-9)


def test_restrictions_alone_make_planes_hinges_and_balls() -> None:
    T = frame(9)
    flat = constraint("Distance", T, T @ SE3.trans(4.0, 5.0, -3.0), -3.0)
    assert read([], flat).type is JointType.PLANAR
    side = T @ SE3.rot_y(math.pi / 2)
    other = replace(constraint("Distance", side, side), name="second")
    slide = read([], flat, other)
    assert slide.type is JointType.SLIDER
    assert abs(float((POSES["a"] @ slide.T_parent_connector).rotation[:, 2] @ T.rotation[:, 1])) == pytest.approx(1.0, abs=1e-9)
    third = replace(constraint("Distance", T @ SE3.rot_x(math.pi / 2), T @ SE3.rot_x(math.pi / 2)), name="third")
    assert read([], flat, other, third).type is JointType.FIXED
    assert read([], constraint("Distance", T, T, points=True)).type is JointType.BALL


def test_what_is_no_joint_of_articad_is_refused_with_a_reason() -> None:
    T = frame(5)
    for alone in (constraint("Parallel", T, T), constraint("Perpendicular", T, T @ SE3.rot_x(math.pi / 2))):
        found = merged([], [alone], POSES)
        assert isinstance(found, tuple)
        assert found[0] is alone
        assert "leaves motions" in found[1]
    askew = merged([joint(JointType.REVOLUTE, T, (0.0,))], [constraint("Angle", T @ SE3.rot_x(1.0), T, 0.5)], POSES)
    assert isinstance(askew, tuple)
    assert "misses its value" in askew[1]


def test_planar_faces_of_a_mesh_are_numbered_and_curved_ones_are_not_among_them() -> None:
    mesh = box(10.0, 20.0, 30.0)
    sides = np.argmax(
        np.abs(
            np.cross(
                mesh.vertices[mesh.triangles[:, 1]] - mesh.vertices[mesh.triangles[:, 0]],
                mesh.vertices[mesh.triangles[:, 2]] - mesh.vertices[mesh.triangles[:, 0]],
            )
        ),
        axis=1,
    )
    below = mesh.vertices[mesh.triangles].mean(axis=1)[np.arange(12), sides] < 0
    mesh = TriMesh(mesh.vertices, mesh.triangles, np.where((sides == 2) & ~below, 1, np.where(sides == 2, 0, 2)).astype(np.int32))
    assert mesh.face is not None
    found = {number: point for number, point, _ in planar_faces(mesh.vertices, mesh.triangles, mesh.face)}
    assert sorted(found) == [1, 2]  # the four sides in one face are not planar
    assert found[2][2] == pytest.approx(15.0)
