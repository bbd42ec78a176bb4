"""Free products come to rest with their convex pieces as they do with much finer ones: dropped on a table, then pushed along it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export import convex
from articad.export.convex import manifold
from articad.export.mjcf import write_mjcf
from articad.geometry.inscribed import inscribed
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from tests.assemblies import STEEL

COUNT = 20
TILT, LIFT_MM = math.radians(4), 2.0  # of the start above a stable pose
PUSH_M_S = 0.3
SECONDS = 1.5  # after the drop, and again after the push
FINER = 8  # share of the default bound, and multiple of the default number of pieces

pytestmark = [pytest.mark.engines, pytest.mark.soak]


def product(rng: np.random.Generator) -> TriMesh:
    """A block with bores, pockets and bosses."""
    size = rng.uniform(30, 80, 3)
    body = manifold(box(*size))
    for _ in range(rng.integers(1, 4)):
        R = SE3.from_axis_angle(np.eye(3)[rng.integers(3)], math.pi / 2)
        at = SE3.from_translation(rng.uniform(-0.4, 0.4, 3) * size)
        tool = cylinder(rng.uniform(3, 10), rng.uniform(20, 120), 48) if rng.random() < 0.5 else box(*rng.uniform(8, 40, 3))
        other = manifold(tool.transformed(at @ R))
        body = body - other if rng.random() < 0.6 else body + other
    found = max(body.decompose(), key=lambda one: one.volume()).to_mesh64()
    return TriMesh(np.array(found.vert_properties[:, :3], dtype=np.float64), np.array(found.tri_verts, dtype=np.int32))


def stable(mesh: TriMesh) -> FloatArray:
    """Return the outward normal of the face of the hull nearest to the centre of mass on which the body stands most safely."""
    hull = convex.hull_mesh(mesh.vertices)
    normals = hull.normals_of_twice_area
    areas = np.linalg.norm(normals, axis=1)
    normals = normals[areas > 1e-9] / areas[areas > 1e-9, None]
    heights = (normals * (hull.vertices[hull.triangles[areas > 1e-9, 0]] - mesh.solid_integrals()[1])).sum(axis=1)
    return np.asarray(normals[int(heights.argmin())])


def standing(mesh: TriMesh) -> TriMesh:
    """Return the mesh turned so that it stands on that face, at z = 0."""
    down = stable(mesh)
    axis, angle = np.cross(down, [0, 0, -1.0]), math.acos(max(-1.0, min(1.0, float(-down[2]))))
    turned = mesh.transformed(SE3.from_axis_angle(axis / np.linalg.norm(axis), angle)) if np.linalg.norm(axis) > 1e-9 else mesh
    if np.linalg.norm(axis) <= 1e-9 and down[2] > 0:
        turned = mesh.transformed(SE3.rot_x(math.pi))
    return turned.transformed(SE3.from_translation([0, 0, -turned.bounds[0, 2]]))


def dropped(mesh: TriMesh, folder: Path) -> list[FloatArray]:
    """Return position [m] and quaternion of the product after the drop, and after the push, in MuJoCo."""
    import mujoco

    table = Part.from_mesh(
        "table", box(3000, 3000, 40), density=STEEL, connectors={"top": Connector("top", SE3.from_translation((0, 0, 20)))}
    )
    thing = Part.from_mesh("thing", mesh, density=STEEL, connectors={"foot": Connector("foot", SE3.identity())})
    joint = declare.free("fall", table["top"], thing["foot"])
    bundle = write_mjcf(
        Assembly.from_parts("drop", parts=[table, thing], joints=[joint], ground="table"), cache=BuildCache(folder / "cache")
    )
    bundle.write(folder)
    model = mujoco.MjModel.from_xml_path(str(folder / bundle.main))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0) if model.nkey else None
    at, v = int(model.jnt_qposadr[0]), int(model.jnt_dofadr[0])
    tilt = SE3.from_axis_angle((1, 0, 0), TILT)
    lowest = float(tilt.apply(mesh.vertices)[:, 2].min())
    data.qpos[at + 2] += (LIFT_MM - lowest) / 1000
    x, y, z, w = tilt.quaternion
    data.qpos[at + 3 : at + 7] = w, x, y, z
    found = []
    for push in (0.0, PUSH_M_S):
        data.qvel[v] += push
        for _ in range(round(SECONDS / model.opt.timestep)):
            mujoco.mj_step(model, data)
        found.append(np.array(data.qpos[at : at + 7]))
        assert float(np.abs(data.qvel[v : v + 6]).max()) < 0.05
    return found


@pytest.mark.parametrize("seed", range(COUNT))
def test_a_dropped_and_pushed_product_rests_as_with_finer_pieces(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = standing(product(np.random.default_rng(seed)))
    coarse = dropped(mesh, tmp_path / "default")

    def finer(shape: TriMesh, **options: Any) -> Any:
        usual = inscribed(shape, **options)
        assert usual is not None
        return inscribed(shape, bound=usual.bound / FINER, **{**options, "most": FINER * options["most"]})

    monkeypatch.setattr(convex, "inscribed", finer)
    fine = dropped(mesh, tmp_path / "finer")
    assert float(np.linalg.norm(fine[1][:2] - fine[0][:2])) > 1e-3  # it was pushed
    for one, other in zip(coarse, fine, strict=True):
        away = 1000 * float(np.linalg.norm(one[:3] - other[:3]))
        turned = math.degrees(2 * math.acos(min(1.0, abs(float(one[3:] @ other[3:])))))
        assert away <= 1, away
        assert turned <= 1, turned
