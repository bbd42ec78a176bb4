"""Outlines of photos: who reads every measure within 10 % passes, and who adds a bar or leaves out a knob or a foot does not."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box, merged
from articad_bench.outline_checks import outlined
from articad_bench.subject import Subject

BODIES: Mapping[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "corpus": ((420, 300, 360), (0, 0, 0)),
    "foot": ((40, 40, 24), (-150, 110, -192)),
    "other foot": ((40, 40, 24), (150, -110, -192)),
    "knob": ((26, 24, 26), (-80, -162, 90)),
    "rail": ((500, 20, 20), (0, 100, 190)),
}
"""Sides and middles of boxes [mm]."""


def cabinet(*left_out: str, **more: tuple[tuple[float, float, float], tuple[float, float, float]]) -> TriMesh:
    rows = [row for name, row in {**BODIES, **more}.items() if name not in left_out]
    return merged([box(*sides).transformed(SE3.from_translation(np.array(middle, dtype=np.float64))) for sides, middle in rows])


def subject(mesh: TriMesh) -> Subject:
    return Subject(Assembly.from_parts("one", parts=[Part.from_mesh("one", mesh, density=700)], joints=[], ground="one"))


def read_by_eye(mesh: TriMesh, seed: int) -> TriMesh:
    """Return a shape all of whose measures are off by up to 10 %, each along the axes for itself."""
    rng, vertices = np.random.default_rng(seed), mesh.vertices.copy()

    def off(places: FloatArray) -> FloatArray:
        levels = np.unique(np.round(places, 6))
        steps = np.diff(levels) * rng.uniform(0.9, 1.1, len(levels) - 1)
        return np.asarray(np.interp(places, levels, np.concatenate([levels[:1], levels[0] + np.cumsum(steps)])))

    for column in range(3):
        vertices[:, column] = off(vertices[:, column])
    return TriMesh(vertices, mesh.triangles)


def eyes(slit: float, high: float = 6.0) -> TriMesh:
    """Two cheeks on a foot, 40 mm wide and high, with an eye between them: one sees through a slit on either side of it, 2 mm below the pin."""
    side = (40 - 12 - 2 * slit) / 2
    rows: list[tuple[tuple[float, float, float], tuple[float, float, float]]] = [
        ((60, 40, 10), (0, 0, 5)),
        ((60, 40, 30 - high), (0, 0, 25 + high / 2)),
        ((60, 12, 30), (0, 0, 25)),
    ]
    rows += [((60, side, 30), (0, sign * (20 - side / 2), 25)) for sign in (-1, 1)]
    return merged([box(*sides).transformed(SE3.from_translation(np.array(middle, dtype=np.float64))) for sides, middle in rows])


@pytest.mark.parametrize(("slit", "high", "passes"), [(0.5, 6, True), (2.0, 4, True), (4.0, 20, False)])
def test_slits_that_one_sees_through_may_be_closed_and_windows_not(slit: float, high: float, passes: bool) -> None:
    closed, open_ = subject(eyes(0.0, high)), subject(eyes(slit, high))

    assert outlined(closed).judge(open_).ok is passes
    assert outlined(open_).judge(closed).ok is passes


@pytest.mark.parametrize("seed", range(6))
def test_who_reads_photos_within_a_tenth_passes_turned_or_not(seed: int) -> None:
    check = outlined(subject(cabinet()))
    found = subject(read_by_eye(cabinet(), seed))

    assert all(check.judge(each).ok for each in (found, found.turned(seed % 4)))


@pytest.mark.parametrize(
    "wrong",
    [
        cabinet("knob"),
        cabinet("rail"),
        cabinet("foot", "other foot"),
        cabinet(bar=((400, 16, 20), (0, 157, -60))),
        cabinet(ball=((30, 30, 26), (60, -60, 192))),
        read_by_eye(cabinet("knob", bar=((400, 16, 20), (0, 157, -60))), 1),
    ],
)
def test_what_is_left_out_or_stands_out_is_refused(wrong: TriMesh) -> None:
    assert not outlined(subject(cabinet())).judge(subject(wrong)).ok
