"""MuJoCo's compiler runs in a process of its own: what it reads, what it answers, and what is made of an answer that is no model."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

from articad.errors import ReadError
from articad.importers import mjcf_compiled
from articad.importers.mjcf import read_mjcf
from articad.importers.mjcf_compiled import compiled_mjcf
from articad.kernels import sandbox

ARM = """<mujoco model="arm"><option timestep="0.01"/><worldbody><geom type="plane" size="1 1 1"/>
  <body name="a" pos="0 0 1"><joint name="j" axis="0 1 0" range="-1 1" limited="true"/><geom type="capsule" size="0.1 0.5"/>
    <body pos="0 0 1"><joint type="ball"/><geom name="tip" size="0.2"/><site name="s"/></body></body></worldbody>
  <keyframe><key name="home" qpos="0.5 1 0 0 0"/></keyframe></mujoco>"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    path = tmp_path / "arm.xml"
    path.write_text(ARM)
    return path


def test_numbers_and_names_are_those_of_mujoco(arm: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(arm))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    compiled = compiled_mjcf(arm, arm.parent)
    for field in ("body_pos", "body_inertia", "jnt_range", "dof_damping", "geom_size", "qpos0"):
        np.testing.assert_array_equal(getattr(compiled, field), getattr(model, field))
    np.testing.assert_array_equal(compiled.xpos, data.xpos)
    assert (compiled.nbody, compiled.njnt, compiled.mjJNT_BALL) == (3, 2, int(mujoco.mjtJoint.mjJNT_BALL))
    assert [compiled.name("BODY", index) for index in range(3)] == ["world", "a", ""]
    assert compiled.word("GEOM", int(compiled.geom_type[1])) == "capsule"


def test_a_height_field_is_no_mesh(tmp_path: Path) -> None:
    path = tmp_path / "terrain.xml"
    path.write_text(
        '<mujoco><asset><hfield name="hills" nrow="3" ncol="3" size="1 1 1 1"/></asset><worldbody><geom type="hfield" hfield="hills"/>'
        '<body><joint/><geom size="0.1"/></body></worldbody></mujoco>'
    )

    assert len(read_mjcf(path).joints) == 1


def test_our_process_does_not_import_mujoco(arm: Path) -> None:
    statement = f"import sys; from articad.importers.mjcf import read_mjcf; read_mjcf({str(arm)!r}); assert 'mujoco' not in sys.modules"
    subprocess.run([sys.executable, "-P", "-c", statement], check=True, timeout=200)


@pytest.mark.skipif("landlock" not in sandbox.available(), reason="the kernel has no Landlock")
def test_the_compiler_reads_nothing_beside_the_root(tmp_path: Path) -> None:
    """Even where our own look at the names fails: here it is left out."""
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.xml").write_text('<mujoco><worldbody><body name="secret"/></worldbody></mujoco>')
    path = inside / "a.xml"
    path.write_text('<mujoco><include file="../secret.xml"/></mujoco>')
    assert "secret" in [compiled_mjcf(path, tmp_path).name("BODY", index) for index in range(2)]
    with pytest.raises(ReadError, match="MuJoCo refuses it"):
        compiled_mjcf(path, inside)


def test_a_compiler_that_does_not_end_is_ended(arm: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mjcf_compiled, "SECONDS", 0.01)
    with pytest.raises(ReadError, match=r"did not end within 0\.01 s"):
        read_mjcf(arm)


def answer(**changes: object) -> bytes:
    """Return the answer of a process for one body, with changes to the description of its model."""
    counts = dict.fromkeys(("nbody", "njnt", "nv", "nq", "ngeom", "nmesh", "nsite", "ncam", "nlight", "neq"), 0) | {"nbody": 1}
    arrays = [("body_parentid", "int32", [1])] + [
        (name, "int32", [0]) for name in ("jnt_dofadr", "jnt_qposadr", "site_bodyid", "geom_type", "geom_dataid")
    ]
    usual = {"counts": counts, "names": {}, "arrays": arrays}
    head = {"words": {"mjGEOM_MESH": 7}, "usual": usual, "model": usual | changes, "warnings": []}
    return json.dumps(head).encode() + b"\n" + bytes(8)


def test_an_answer_is_read() -> None:
    assert mjcf_compiled._read(answer(), Path("a.xml")).nbody == 1


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"[]\n",
        b"{" * 100_000,
        answer()[:-4],  # an array that ends early
        answer(arrays=[("body_parentid", "object", [1])]),
        answer(arrays=[("body_parentid", "float64", [10**12])]),
        answer(arrays=[("body_parentid", "float64", [-1])]),
        answer(counts={"nbody": 2}),
        answer(counts={"nbody": "many"}),
        answer(names=None),
    ],
)
def test_an_answer_that_is_no_model_is_refused(data: bytes) -> None:
    with pytest.raises(ReadError, match="gave no model"):
        mjcf_compiled._read(data, Path("a.xml"))
