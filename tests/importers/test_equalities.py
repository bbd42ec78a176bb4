"""Equalities of MJCF: bodies of an assembly that was read stand where MuJoCo's own constraints have no residual."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from articad.connectors.se3 import SE3
from articad.importers.mjcf import read_mjcf

pytestmark = pytest.mark.engines

BODY = '<geom type="box" size=".05 .04 .03" mass="1"/>'


def pose(random: np.random.Generator) -> tuple[str, str]:
    quat = random.normal(size=4)
    return " ".join(f"{x:.4f}" for x in random.uniform(-0.4, 0.4, 3)), " ".join(f"{x:.4f}" for x in quat / np.linalg.norm(quat))


def equality(kind: str, random: np.random.Generator) -> str:
    pos, quat = pose(random)
    anchor = pose(random)[0]
    return {
        "weld": '<weld body1="a" body2="b"/>',
        "weld to the world": f'<weld body1="b" relpose="{pos} {quat}"/>',
        "relpose": f'<weld body1="a" body2="b" relpose="{pos} {quat}"/>',
        "relpose and anchor": f'<weld body1="a" body2="b" relpose="{pos} {quat}" anchor="{anchor}" torquescale="0.3"/>',
        "anchor": f'<weld body1="a" body2="b" anchor="{anchor}"/>',
        "sites": '<weld site1="sa" site2="sb"/>',
        "no torque": f'<weld body1="a" body2="b" relpose="{pos} {quat}" anchor="{anchor}" torquescale="0"/>',
        "connect": f'<connect body1="a" body2="b" anchor="{anchor}"/>',
        "connect sites": '<connect site1="sa" site2="sb"/>',
    }[kind]


KINDS = ["weld", "weld to the world", "relpose", "relpose and anchor", "anchor", "sites", "no torque", "connect", "connect sites"]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", KINDS)
def test_what_was_read_satisfies_mujocos_own_equality(kind: str, seed: int, tmp_path: Path) -> None:
    """One body moves freely, so that it can be where the equality wants it; the other turns on a joint below a turned body."""
    import mujoco

    random = np.random.default_rng(seed)
    (p, q), (pb, qb), (sa, ra), (sb, rb) = (pose(random) for _ in range(4))
    path = tmp_path / "m.xml"
    path.write_text(
        f'<mujoco><worldbody><body name="base" pos="{p}" quat="{q}">{BODY}<body name="a" pos="0.1 0 0.2"><joint name="hinge" axis="0 1 1"/>'
        f'{BODY}<site name="sa" pos="{sa}" quat="{ra}"/></body></body><body name="b" pos="{pb}" quat="{qb}"><freejoint name="free"/>{BODY}'
        f'<site name="sb" pos="{sb}" quat="{rb}"/></body></worldbody><equality>{equality(kind, random)}</equality></mujoco>'
    )
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)

    rest = read_mjcf(path).at()

    T = rest["world"].inverse() @ rest["b"]
    data.qpos[1:8] = [*(T.translation / 1000), *np.roll(T.quaternion, 1)]
    arm = (
        SE3.from_quaternion(np.roll(model.body("base").quat, -1), model.body("base").pos * 1000).inverse()
        @ rest["world"].inverse()
        @ rest["a"]
    )
    axis = np.array([0, 1, 1]) / np.sqrt(2)
    data.qpos[0] = 2 * np.arctan2(arm.quaternion[:3] @ axis, arm.quaternion[3])
    mujoco.mj_forward(model, data)
    rows = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    assert rows.sum() == (3 if "connect" in kind else 6)
    assert np.abs(data.efc_pos[rows]).max() < 1e-6


def test_what_is_not_taken_over_is_named(tmp_path: Path) -> None:
    path = tmp_path / "m.xml"
    path.write_text(
        f'<mujoco><worldbody><body name="a"><joint name="j" axis="1 0 0"/>{BODY}</body><body name="b" pos="1 0 0">'
        f'<joint name="k" axis="1 0 0"/>{BODY}</body></worldbody><tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>'
        '<equality><weld name="off" body1="a" body2="b" active="false"/><tendon name="rope" tendon1="t"/>'
        '<joint name="curve" joint1="j" joint2="k" polycoef="0 1 0.5 0 0"/></equality></mujoco>'
    )

    dropped = {finding.where for finding in read_mjcf(path).findings.of("W_IMPORT_DROPPED")}

    assert {"equality.off", "equality.rope", "equality.curve"} <= dropped
