"""Cheats that meet the numbers of a text and miss its words: foam for oak, a block for a drawer, a way back for a way out, a notch, a pin half out, a bar.

Each is tried where a check of the task says that it is meant: whoever adds such a check to a task has the cheat tried on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import manifold3d
import numpy as np

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box
from articad.kinematics.joints import Joint
from articad_bench.bodies import moved_bodies
from articad_bench.checks import Reaches
from articad_bench.machined_checks import Machined
from articad_bench.outline_checks import Outlined
from articad_bench.room_checks import Weighs
from articad_bench.shape_checks import Holds
from articad_bench.staged_cheats import of_the_same
from articad_bench.subject import Subject
from articad_bench.task import Task

__all__ = ["TRICKS"]

FOAM: Final = 1.0  # kg/m³
NOTCH: Final = 0.01  # of a part's volume that is cut off it, at least
SLIP: Final = 0.05  # of the product's diagonal
BAR: Final = (0.3, 0.06, 0.06)  # sides, as shares of the product's diagonal
OUT: Final = 0.03  # of the diagonal, by which a bar stands out
GROWN: Final = 1.15  # times as large as before is each notch that is tried
TRIED: Final = 40


def _weightless(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference of foam, if something of it is to weigh what it is made of."""
    if not _of(task, Weighs):
        return None
    return _with(reference, {name: Part.from_mesh(name, _mesh(reference, name), density=FOAM) for name in _shaped(reference)})


def _brimful(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with its drawers solid, or what its lid covers."""
    subject, names = Subject(reference), set[str]()
    for check in (check for check in _of(task, Holds) if isinstance(check, Holds)):
        named = check.joint or check.without
        bodies = {body for joint in (named.found(subject) if named else ()) for body in moved_bodies(subject, joint)}
        names |= {name for name in subject.shaped if named is not None and (subject.rigid[name] in bodies) == (check.joint is not None)}
    parts = {name: filled for name in names if (filled := _hull(reference, subject, name)) is not None}
    return _with(reference, parts) if parts else None


def _hull(reference: Assembly, subject: Subject, name: str) -> Part | None:
    """Return a part as large as its convex hull, without what lies in it."""
    here = subject.rest[name].inverse()
    others = [_solid(_mesh(reference, other).transformed(here @ subject.rest[other])) for other in subject.shaped if other != name]
    whole = _solid(_mesh(reference, name)).hull()
    left = manifold3d.Manifold.batch_boolean([whole, *others], manifold3d.OpType.Subtract)
    return _part(reference, name, left + _solid(_mesh(reference, name)))


def _backward(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference whose joints go to the other side of rest, if a check says which side they go to."""
    if not _of(task, Reaches):
        return None
    joints = [_reflected(joint) for joint in reference.joints]
    if all(after is before for after, before in zip(joints, reference.joints, strict=True)):
        return None
    return replace(reference, mechanism=reference.mechanism.changed(joints=joints))


def _reflected(joint: Joint) -> Joint:
    ends = (*joint.limits.lower, *joint.limits.upper)
    if not ends or not all(map(math.isfinite, ends)):
        return joint
    rows = list(zip(joint.limits.lower, joint.limits.upper, joint.rest, strict=True))
    if all(abs((upper - rest) - (rest - lower)) <= 0.05 * (upper - lower) for lower, upper, rest in rows):
        return joint
    lower, upper = (tuple(2 * row[2] - row[end] for row in rows) for end in (1, 0))
    return replace(joint, limits=replace(joint.limits, lower=lower, upper=upper))


def _notched(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with a corner of its largest part cut off, 1 % of it, if sheets show each of its faces."""
    if not _of(task, Machined):
        return None
    name = max(_shaped(reference), key=lambda each: abs(_mesh(reference, each).volume))
    mesh = _mesh(reference, name)
    whole, (low, high), part = _solid(mesh), mesh.bounds, None
    size = 0.05 * float(np.min(high - low))
    for corner in (low, high, np.array([low[0], high[1], low[2]]), np.array([high[0], low[1], high[2]])):
        for step in range(TRIED):
            side = size * GROWN**step
            left = whole - _solid(box(side, side, side).transformed(SE3.from_translation(corner)))
            cut = 1 - left.volume() / whole.volume()
            if NOTCH <= cut <= 2 * NOTCH and (part := _part(reference, name, left)) is not None:
                return _with(reference, {name: part})
    return None


def _slipped(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with its last part beside its place, along its longest side, if sheets show where it lies."""
    names = [name for name in _shaped(reference) if name != reference.ground]
    if not _of(task, Machined) or not names:
        return None
    name, subject = names[-1], Subject(reference)
    mesh = _mesh(reference, name)
    way = np.eye(3)[int(np.argmax(np.ptp(mesh.vertices, axis=0)))] * SLIP * float(np.linalg.norm(subject.size))
    return _with(reference, {name: of_the_same(reference.parts[name], mesh.transformed(SE3.from_translation(way)))})


def _barred(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with a bar on the back of its largest part, if a picture shows its outlines."""
    if not _of(task, Outlined):
        return None
    subject = Subject(reference)
    name = max(_shaped(reference), key=lambda each: abs(_mesh(reference, each).volume))
    corners, diagonal = subject.rest[name].apply(_mesh(reference, name).vertices), float(np.linalg.norm(subject.size))
    middle, (low, high) = corners[np.lexsort(np.round(corners.T[[0, 2, 1]], 3))[-1]], subject.corners(subject.rest)
    ends = [middle + side * diagonal / 2 * np.array(BAR) for side in (-1, 1)]
    low, high = np.clip(ends, low, high + np.array([0, OUT * diagonal, 0]))  # the whole stays as wide and high as it is
    bar = box(*(high - low).tolist()).transformed(subject.rest[name].inverse() @ SE3.from_translation((low + high) / 2))
    part = _part(reference, name, _solid(_mesh(reference, name)) + _solid(bar))
    return None if part is None else _with(reference, {name: part})


TRICKS: Final[Mapping[str, Callable[[Task, Assembly], Assembly | None]]] = {
    "weightless": _weightless,
    "brimful": _brimful,
    "backward": _backward,
    "notched": _notched,
    "slipped": _slipped,
    "barred": _barred,
}
"""Makers of these cheats."""


def _of(task: Task, kind: type[object]) -> list[object]:
    """Return the checks of a kind."""
    return [check for check in task.checks if isinstance(check, kind)]


def _shaped(reference: Assembly) -> dict[str, Part]:
    return {name: part for name, part in reference.parts.items() if part.mesh is not None}


def _mesh(reference: Assembly, name: str) -> TriMesh:
    mesh = reference.parts[name].mesh
    assert mesh is not None
    return mesh


def _with(reference: Assembly, parts: Mapping[str, Part]) -> Assembly:
    return replace(reference, parts={**reference.parts, **parts})


def _solid(mesh: TriMesh) -> manifold3d.Manifold:
    welded = mesh.welded(1e-6)
    return manifold3d.Manifold(manifold3d.Mesh64(np.array(welded.vertices, dtype=np.float64), np.array(welded.triangles, dtype=np.uint64)))


def _part(reference: Assembly, name: str, body: manifold3d.Manifold) -> Part | None:
    """Return a part that is the largest piece of a body; None if there is none."""
    pieces = [piece for piece in body.decompose() if piece.volume() > 0]
    if body.status() != manifold3d.Error.NoError or not pieces:
        return None
    found = max(pieces, key=lambda piece: piece.volume()).to_mesh64()
    mesh = TriMesh(np.asarray(found.vert_properties)[:, :3].astype(np.float64), np.asarray(found.tri_verts).astype(np.int32))
    return of_the_same(reference.parts[name], mesh)
