"""Collision shapes: hulls and convex pieces, what they add, and the contacts that they must not bring."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export import convex
from articad.export.contacts import poses_in_motion
from articad.export.convex import pieces_of, whole_hull
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box, tube
from articad.interference.body import Body
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from tests.assemblies import STEEL, block, four_bar, frame

WRITERS: dict[str, Any] = {"urdf": write_urdf, "mjcf": write_mjcf}


@pytest.fixture(scope="module")
def cache(tmp_path_factory: Any) -> BuildCache:
    return BuildCache(tmp_path_factory.mktemp("pieces"))


def channel() -> TriMesh:
    """A channel along x, 100 mm long, open above: a floor and two walls, 10 mm thick, 40 mm wide inside."""
    profile = [(-30, 0), (30, 0), (30, 40), (20, 40), (20, 10), (-20, 10), (-20, 40), (-30, 40)]
    n = len(profile)
    vertices = np.array([(x, y, z) for x in (-50.0, 50.0) for y, z in profile])
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    sides = [(i, (i + 1) % n) for i in range(n)]
    triangles = [(a, c, b) for a, b, c in caps] + [(a + n, b + n, c + n) for a, b, c in caps]
    triangles += [corner for i, j in sides for corner in ((i, j, j + n), (i, j + n, i + n))]
    return TriMesh(vertices, np.array(triangles))


def sledge(*, from_outside: bool) -> Assembly:
    """A block that slides in a channel which stands on a base: no joint connects the two."""
    base = block("base", (10, 10, 5), foot=frame(at=(0, 0, -200)), rail=frame(at=(-150.0 if from_outside else 0.0, 0, 25), z=(1, 0, 0)))
    rail = Part.from_mesh("rail", channel(), density=STEEL, connectors={"foot": Connector("foot", SE3.from_translation((0, 0, -200)))})
    slider = block("slider", (20, 30, 20), rail=frame(z=(1, 0, 0)))
    joints = [
        declare.revolute("stand", base["foot"], rail["foot"], limits=(0, 0.001)),
        declare.slider("slide", base["rail"], slider["rail"], limits=(0.0, 150.0) if from_outside else (-20.0, 20.0)),
    ]
    return Assembly.from_parts("sledge", parts=[replace(base, collisions=()), rail, slider], joints=joints, ground="base")


def test_the_channel_is_a_body() -> None:
    assert Body(channel()).fault is None
    assert channel().volume == pytest.approx(100 * (60 * 40 - 40 * 30))


@pytest.mark.parametrize("from_outside", [False, True])
@pytest.mark.parametrize("writer", WRITERS)
def test_hulls_that_meet_at_rest_or_only_in_motion_are_told(writer: str, from_outside: bool) -> None:
    bundle = WRITERS[writer](sledge(from_outside=from_outside))

    assert "parts.rail+slider" in [loss.where for loss in bundle.losses]
    assert (b'body1="rail" body2="slider"' in bundle.files[bundle.main]) == (writer == "mjcf")


@pytest.mark.parametrize("from_outside", [False, True])
@pytest.mark.parametrize("writer", WRITERS)
def test_pieces_let_the_slider_pass(writer: str, from_outside: bool, cache: BuildCache) -> None:
    bundle = WRITERS[writer](sledge(from_outside=from_outside), collision="pieces", cache=cache)

    assert "parts.rail+slider" not in [loss.where for loss in bundle.losses]
    assert b'body1="rail" body2="slider"' not in bundle.files[bundle.main]
    (error,) = (loss for loss in bundle.losses if loss.where == "parts.rail")
    assert "3 of them" in error.kept
    assert not error.refused


@pytest.mark.engines
def test_mujoco_holds_the_slider_in_its_channel_without_contact(cache: BuildCache, tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(sledge(from_outside=True), collision="pieces", cache=cache)
    bundle.write(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main))
    data = mujoco.MjData(model)
    for travel in np.linspace(0, 0.15, 31):
        data.qpos[:] = [0, travel]
        mujoco.mj_forward(model, data)

        assert data.ncon == 0
    slides = model.joint("slide").qposadr[0]
    data.qpos[slides] = 0.15
    model.body_pos[model.body("slider").id][1] += 0.01  # pushed through the wall: now there must be contact
    mujoco.mj_forward(model, data)

    assert data.ncon > 0


def test_a_pair_that_no_fineness_parts_is_excluded(cache: BuildCache, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(convex, "_kept", lambda mesh, *_: whole_hull(mesh).meshes)
    bundle = write_mjcf(sledge(from_outside=True), collision="pieces", cache=cache)

    assert b'body1="rail" body2="slider"' in bundle.files[bundle.main]


def test_pieces_are_measured_against_the_solid(cache: BuildCache) -> None:
    ring = tube(20, 30, 10, 12)
    found, whole = pieces_of(ring, 0, cache), whole_hull(ring)

    assert whole.more == pytest.approx(0.8)  # 30² / (30² − 20²) − 1
    assert sum(piece.volume for piece in found.meshes) >= (1 + found.more - found.less) * ring.volume * (1 - 1e-9)
    assert max(found.more, found.less) < 1e-2
    assert all(piece.is_closed and piece.volume > 0 for piece in found.meshes)


def test_a_convex_shape_is_its_own_piece(cache: BuildCache) -> None:
    found = pieces_of(box(10, 20, 30), 0, cache)

    assert len(found.meshes) == 1
    assert found.meshes[0].volume == pytest.approx(6000)
    assert (found.more, found.less) == pytest.approx((0, 0), abs=1e-12)


def test_pieces_are_kept_by_shape(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache = BuildCache(tmp_path)
    first = pieces_of(channel(), 0, cache)
    monkeypatch.setitem(sys.modules, "coacd", None)  # whoever runs it now fails
    again = pieces_of(channel(), 0, cache)

    assert [mesh.digest for mesh in again.meshes] == [mesh.digest for mesh in first.meshes]


def test_pieces_come_out_the_same_twice(tmp_path: Path) -> None:
    first, again = (pieces_of(channel(), 0, BuildCache(tmp_path / name)) for name in "ab")

    assert [mesh.digest for mesh in again.meshes] == [mesh.digest for mesh in first.meshes]


def test_motion_is_sampled_as_far_as_loops_go() -> None:
    mechanism = four_bar((-1.0, 1.0)).mechanism
    poses = poses_in_motion(mechanism)

    assert len(poses) > 5
    assert np.allclose(poses[0], mechanism.poses(mechanism.rest).matrix)
