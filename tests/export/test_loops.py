"""Loops in MuJoCo: the equality constraints of every kind of closing joint hold at `home`, and tie what they should."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

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
