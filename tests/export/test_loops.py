"""Loops in MuJoCo: the equality constraints of every kind of closing joint hold at `home`, and tie what they should."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.kinematics import declare
from tests.assemblies import closed

Closing = Callable[[Any, Any], Any]
HALF_PI = math.pi / 2

# each kind, and how many directions of the closing point and frame it leaves free
KINDS: dict[str, tuple[Closing, int]] = {
    "fixed": (lambda a, b: declare.fixed("d", a, b), 0),
    "endless revolute": (lambda a, b: declare.revolute("d", a, b, limits="endless", mate="opposed"), 1),
    "revolute": (lambda a, b: declare.revolute("d", a, b, limits=(-3, 3), rest=0.5, mate="opposed"), 1),
    "slider": (lambda a, b: declare.slider("d", a, b, limits=(-20, 20), rest=5.0), 1),
    "cylindrical": (lambda a, b: declare.cylindrical("d", a, b, travel=(-20, 20), angle="endless", rest=(5.0, 0.3)), 2),
    "ball": (lambda a, b: declare.ball("d", a, b, cone=1.0), 3),
    "screw": (lambda a, b: declare.screw("d", a, b, lead=4.0, limits=(-9, 9), rest=1.0, mate="opposed"), 1),
    "planar": (lambda a, b: declare.planar("d", a, b, x=(-9, 9), y=(-9, 9), angle="endless"), 3),
    "universal": (lambda a, b: declare.universal("d", a, b, a=(-1, 1), b=(-1, 1), mate="opposed"), 2),
}


def loaded(assembly: Assembly, folder: Path) -> tuple[Any, Any]:
    import mujoco

    bundle = write_mjcf(assembly)
    bundle.write(folder)
    model = mujoco.MjModel.from_xml_path(str(folder / bundle.main))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    return model, data


def equality_rows(model: Any, data: Any) -> Any:
    import mujoco

    rows = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    J = np.zeros((data.nefc, model.nv))
    if mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(J, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    else:
        J = data.efc_J.reshape(data.nefc, model.nv)
    return data.efc_pos[rows], J[rows]


@pytest.mark.engines
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("declared", ["from the ground", "to the ground"])
def test_loops_of_every_kind_are_closed_at_home(kind: str, declared: str, tmp_path: Path) -> None:
    closing, _ = KINDS[kind]
    residual, _ = equality_rows(*loaded(closed(closing, turned=declared == "to the ground"), tmp_path))

    assert len(residual) >= 3
    assert np.abs(residual).max() < 1e-9


@pytest.mark.engines
@pytest.mark.parametrize("kind", KINDS)
def test_a_closing_joint_takes_as_many_directions_as_it_should(kind: str, tmp_path: Path) -> None:
    """Three parallel hinges move in their plane only: what the closing joint leaves free there is what remains."""
    closing, _ = KINDS[kind]
    model, data = loaded(closed(closing), tmp_path)
    _, J = equality_rows(model, data)
    scale = np.where(model.jnt_type[model.dof_jntid] == 2, 0.01, 1.0)  # slides in cm, so that the rank is one of like numbers
    s = np.linalg.svd(J * scale, compute_uv=False)
    mobility = model.nv - int((s > 1e-7 * s[0]).sum())
    # three links in a plane have three freedoms; the closing joint's axes are those of the plane's normal
    expected = {
        "fixed": 0,
        "slider": 0,
        "endless revolute": 1,
        "revolute": 1,
        "cylindrical": 1,
        "ball": 1,
        "screw": 0,
        "planar": 3,
        "universal": 0,
    }

    assert mobility == expected[kind]


@pytest.mark.engines
@pytest.mark.parametrize("kind", ["endless revolute", "revolute", "cylindrical"])
def test_a_loop_stays_closed_while_it_falls(kind: str, tmp_path: Path) -> None:
    import mujoco

    model, data = loaded(closed(KINDS[kind][0]), tmp_path)
    model.opt.gravity[:] = 0, -9.81, 0
    start = data.qpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    residual, _ = equality_rows(model, data)

    assert np.abs(data.qpos - start).max() > 0.05
    assert np.abs(residual).max() < 1e-4


def test_ghosts_take_their_mass_from_the_part_they_stand_for(tmp_path: Path) -> None:
    assembly = closed(KINDS["cylindrical"][0])
    model, _ = loaded(assembly, tmp_path)

    assert model.body_mass.sum() == pytest.approx(sum(part.mass.mass for part in assembly.parts.values() if part.mass), rel=1e-12)


def test_urdf_leaves_the_closing_joint_out_and_says_so() -> None:
    bundle = write_urdf(closed(KINDS["revolute"][0]))

    assert [loss.where for loss in bundle.losses if loss.refused] == ["joints.d"]
    assert b'<joint name="d"' not in bundle.files[bundle.main]


def test_the_limits_of_a_ball_that_closes_a_loop_are_lost_in_mjcf() -> None:
    assert [loss.lost for loss in write_mjcf(closed(KINDS["ball"][0])).losses if loss.refused] == [
        "the cone and twist of a ball that closes a loop"
    ]


POINTS = {"fixed": 3, "endless revolute": 2, "ball": 1, "cylindrical": 0}


@pytest.mark.engines
@pytest.mark.parametrize(("kind", "flavour"), list(product(POINTS, ["isaac", "drake"])))
def test_points_that_close_a_loop_meet_at_rest(kind: str, flavour: Any, tmp_path: Path) -> None:
    import pinocchio as pin

    assembly = closed(KINDS[kind][0])
    bundle = write_urdf(assembly, loops=flavour)
    bundle.write(tmp_path)
    root = etree.fromstring(bundle.files[bundle.main])
    model = pin.buildModelFromUrdf(str(tmp_path / bundle.main))  # unchanged, whatever the flavour
    data = model.createData()
    q = pin.neutral(model)
    for name, value in (("crank", 1.0), ("pin_b", -0.6), ("pin_c", -0.9)):
        joint = model.joints[model.getJointId(name)]
        q[joint.idx_q : joint.idx_q + 2] = math.cos(value), math.sin(value)
    pin.framesForwardKinematics(model, data, q)
    points = isaac_points(root) if flavour == "isaac" else drake_points(root)

    assert len(points) == POINTS[kind]
    for (near, p_near), (far, p_far) in points:
        placed = [data.oMf[model.getFrameId(link)].act(np.array(p)) for link, p in ((near, p_near), (far, p_far))]
        assert np.abs(placed[0] - placed[1]).max() < 1e-12
    lost = [loss for loss in bundle.losses if loss.where == "joints.d"]
    assert lost[0].refused == (POINTS[kind] == 0)


def isaac_points(root: Any) -> list[Any]:
    return [
        [(end.get("link"), floats(end.get("xyz"))) for end in (loop.find("link1"), loop.find("link2"))]
        for loop in root.iterfind("loop_joint")
    ]


def drake_points(root: Any) -> list[Any]:
    namespace = {"drake": "http://drake.mit.edu"}
    return [
        [
            (tie.find(f"drake:{body}", namespace).get("name"), floats(tie.find(f"drake:{point}", namespace).get("value")))
            for body, point in (("body_A", "p_AP"), ("body_B", "p_BQ"))
        ]
        for tie in root.iterfind("drake:ball_constraint", namespace)
    ]


def floats(text: str) -> list[float]:
    return [float(word) for word in text.split()]
