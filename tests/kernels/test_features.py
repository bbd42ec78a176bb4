"""A connector's kind orders a feature: random parts that have it, in any place, and parts that do not."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import trimesh
from build123d import Axis, Box, Pos, fillet
from numpy.random import default_rng

from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.faces import faces_of
from articad.geometry.mesh import TriMesh
from articad.kernels.features import Order, bore_findings, feature_findings
from articad.kernels.tessellation import tessellate

SEEDS = range(8)


def mesh_of(shape: trimesh.Trimesh, T: SE3) -> TriMesh:
    return TriMesh(T.apply(shape.vertices), np.asarray(shape.faces, dtype=np.int32))


def place(seed: int) -> SE3:
    return SE3.exp(np.concatenate([default_rng(seed).uniform(-80, 80, 3), default_rng(seed + 99).normal(size=3)]))


def found(kind: str, frame: SE3, mesh: TriMesh) -> tuple[str, ...]:
    return feature_findings("part", {"at": Connector("at", frame, kind=kind)}, mesh).codes


def tube(seed: int) -> trimesh.Trimesh:
    inner, wall, height = default_rng(seed).uniform(2, 20, 3)
    return trimesh.creation.annulus(inner, inner + wall, height, sections=48)


def board(seed: int) -> trimesh.Trimesh:
    return trimesh.creation.box(default_rng(seed).uniform(5, 300, 3))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", ["bore_axis", "shaft_axis"])
def test_an_axis_needs_something_round_about_it(kind: str, seed: int) -> None:
    T = place(seed)
    along = SE3.from_translation((0, 0, float(default_rng(seed).uniform(-50, 50))))
    tilt = SE3.rot_x(0.1)

    assert found(kind, T @ along, mesh_of(tube(seed), T)) == ()
    assert found(kind, T @ SE3.from_translation((2, 0, 0)), mesh_of(tube(seed), T)) == ("W_CONNECTOR_FEATURE",)
    assert found(kind, T @ tilt, mesh_of(tube(seed), T)) == ("W_CONNECTOR_FEATURE",)
    assert found(kind, T, mesh_of(board(seed), T)) == ("W_CONNECTOR_FEATURE",)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_mount_needs_a_face_or_material_there(seed: int) -> None:
    T, shape = place(seed), board(seed)
    half = shape.extents / 2
    outside = SE3.from_translation((half[0] + 5, half[1] + 5, half[2] + 5))

    assert found("mount_face", T @ SE3.from_translation((0, 0, half[2])), mesh_of(shape, T)) == ()  # in the middle of a face
    assert found("mount_face", T @ SE3.from_translation((half[0] + 40, 0, half[2])), mesh_of(shape, T)) == ()  # in its plane, beside it
    assert found("mount_face", T @ SE3.from_translation((half[0], 0, half[2] / 3)), mesh_of(shape, T)) == ()  # z along the face
    assert found("mount_face", T @ outside, mesh_of(shape, T)) == ("W_CONNECTOR_FEATURE",)


@pytest.mark.parametrize("kind", ["frame", "hinge_axis", "slide_axis", "ball_centre", "gear_axis", "thread_axis"])
def test_other_kinds_may_lie_in_empty_space(kind: str) -> None:
    assert found(kind, SE3.from_translation((900, 900, 900)), mesh_of(board(0), place(0))) == ()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_part_mirrored_turned_or_in_inches_loses_the_face(seed: int) -> None:
    shape, T = board(seed), place(seed)
    low = shape.extents / 2
    shape.apply_translation(low)  # from 0 to its sizes, as scripts build boards
    frame = T @ SE3.from_translation(shape.extents * (1, 0.5, 1)) @ SE3.rot_x(0.4)
    wrong = {
        "mirrored": shape.copy().apply_transform(np.diag([-1, 1, 1, 1.0])),
        "inches": shape.copy().apply_scale(1 / 25.4),
        "turned": shape.copy().apply_transform(SE3.rot_z(np.pi).matrix),
    }

    assert found("mount_face", frame, mesh_of(shape, T)) == ()
    assert [found("mount_face", frame, mesh_of(one, T)) for one in wrong.values()] == [("W_CONNECTOR_FEATURE",)] * 3


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bore_like_a_needle_cannot_be_made(seed: int) -> None:
    T, rng = place(seed), default_rng(seed)
    width = float(rng.uniform(0.05, 0.45))

    def codes(width: float, depth: float) -> tuple[str, ...]:
        shape = trimesh.creation.annulus(width / 2, width / 2 + 5, depth, sections=48)
        return bore_findings("part", mesh_of(shape, T)).codes

    assert codes(width, 12 * width) == ("W_BORE_NARROW",)
    assert codes(width, 8 * width) == ()
    assert codes(0.55, 60) == ()


@pytest.mark.parametrize("times", [1, 2])
def test_the_dimension_that_states_a_bore_like_a_needle_is_told_in_millimetres(times: int) -> None:
    """Fault: a bore in inches, stated as a diameter or a radius."""
    meant = 5.0
    width = times * meant / 25.4
    mesh = mesh_of(trimesh.creation.annulus(width / 2, width / 2 + 5, 40, sections=64), place(1))
    (found,) = bore_findings("part", mesh, {"parts.part.dimensions.length": 40.0, "parts.part.dimensions.hole": meant / 25.4})
    assert "Set parts.part.dimensions.hole to 5, which states it." in (found.hint or "")


def test_a_sharp_inner_fillet_is_no_bore() -> None:
    angle = Box(20, 20, 60) - Pos(5, 5, 0) * Box(20, 20, 60)
    corner = angle.edges().filter_by(Axis.Z).sort_by_distance((-5, -5, 0))[0]
    found = tessellate(fillet(corner, 0.2).wrapped, 0.01, math.radians(5))
    mesh = TriMesh(found.vertices, found.triangles, found.face)

    assert any(face.kind == "cylinder" and face.hollow for face in faces_of(mesh))
    assert bore_findings("part", mesh).codes == ()


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("frame", ["part", "assembly"])
def test_of_a_connector_and_the_bore_beside_it_that_is_at_fault_which_no_dimension_puts_there(seed: int, frame: str) -> None:
    """A tube at (x, y), where two dimensions put it. Either the connector or the tube is beside this place."""
    draw = default_rng(seed)
    x, y, off = (float(value) for value in draw.uniform(5, 50, 3).round(3))
    lengths = {"x": x, "y": 2 * y, "height": 30.0}
    there = SE3.from_translation((x, y, 0.0))
    aside = SE3.from_translation((x + off, y, 0.0))
    pose = place(seed) if frame == "assembly" else SE3.identity()
    order = Order(lengths, {"at": pose})

    def told(connector: SE3, shape: SE3, given: Order | None) -> Finding:
        (finding,) = feature_findings("part", {"at": Connector("at", connector, kind="bore_axis")}, mesh_of(tube(seed), shape), given)
        return finding

    of_plan, of_script = told(aside, there, order), told(there, aside, order)
    assert (of_plan.route, of_script.route) == ("design", "code")
    assert f"{off:.4g} mm beside it" in of_plan.message
    assert f"{off:.4g} mm beside it" in of_script.message
    wanted = re.search(r"set o of part\.at to \((.*?)\)", of_plan.hint)
    assert wanted
    assert np.allclose([float(value) for value in wanted[1].split(",")], pose.apply(there.translation), atol=1e-3)
    assert told(aside, there, None).route == "code"
