"""How far joined parts, and those fixed to them, are apart at rest, kept in the cache of built parts by their shapes and poses."""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Sequence
from itertools import chain
from typing import TYPE_CHECKING, Final

import manifold3d
import numpy as np

from articad.errors import ArticadError
from articad.export.convex import manifold
from articad.export.hulls import Pair, mating_pairs, rigid_groups
from articad.export.meshes import SCHEME as DRAWN
from articad.export.meshes import drawn
from articad.export.once import once
from articad.geometry.mesh import TriMesh
from articad.interference.boxes import meeting_boxes
from articad.kernels.cache import BuildCache
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

TOUCHING_MM: Final = 1.0  # largest gap of two joined parts that touch by design; it includes the play of their fit
RESTING_MM: Final = 0.01  # largest gap of two parts of which one lies on the other
_SCHEME: Final = "articad.gaps/1"  # must change with how gaps are measured
_FILE: Final = "gaps.json"


def gaps_at_rest(assembly: Assembly) -> dict[Pair, float | None]:
    """Return the distances of joined parts at rest up to `TOUCHING_MM`, measured on the visual meshes; None where one has no solid."""
    return _measured(assembly, mating_pairs(assembly.mechanism.joints, assembly.mechanism.parts), TOUCHING_MM)


def resting(assembly: Assembly) -> dict[Pair, str]:
    """Return the pairs of parts that touch at rest while the joint between their bodies connects others, and the name of that joint.

    Such as a rail that lies on a bracket and turns about a pin which is fixed to the bracket.
    """
    joints, order = assembly.mechanism.joints, assembly.mechanism.parts
    group, joined = rigid_groups(joints, order), set(mating_pairs(joints, order))
    moving = [one for one in joints if one.type is not JointType.FREE and group[one.parent] != group[one.child]]
    names = {frozenset((group[one.parent], group[one.child])): one.name for one in moving}
    between = {pair: name for pair in _near(assembly) - joined if (name := names.get(frozenset((group[pair[0]], group[pair[1]]))))}
    gaps = _measured(assembly, sorted(between), RESTING_MM)
    return {pair: between[pair] for pair, gap in gaps.items() if gap is not None and gap < RESTING_MM}


def _near(assembly: Assembly) -> set[Pair]:
    """Return the pairs of parts whose boxes at rest are nearer than `RESTING_MM`."""
    rest, names, low, high = assembly.mechanism.rest_poses(), [], [], []
    for name in assembly.mechanism.parts:
        corners = [shape.frame.apply(shape.mesh.vertices) for shape in assembly.parts[name].collisions if _is_solid(shape.mesh)]
        if corners:
            placed = rest[name].apply(np.concatenate(corners))
            names.append(name)
            low.append(placed.min(axis=0) - RESTING_MM)
            high.append(placed.max(axis=0) + RESTING_MM)
    if not names:
        return set()
    return {(names[i], names[j]) for i, j in meeting_boxes(np.array(low), np.array(high)).tolist()}


def _measured(assembly: Assembly, pairs: Sequence[Pair], most: float) -> dict[Pair, float | None]:
    """Return the distances of pairs of parts at rest up to a distance [mm], measured on the visual meshes; None where one has no solid.

    The cache of built parts keeps them by shapes and poses. A failure to write there is ignored.
    """
    rest = assembly.mechanism.rest_poses()
    solids = {name: [shape for shape in assembly.parts[name].collisions if _is_solid(shape.mesh)] for name in chain.from_iterable(pairs)}
    digest = hashlib.sha256(f"{_SCHEME} {DRAWN} {most}".encode())
    for name in chain.from_iterable(pairs):
        digest.update(rest[name].matrix.tobytes())
        for shape in solids[name]:
            digest.update(shape.mesh.digest.encode() + shape.frame.matrix.tobytes())
    cache = BuildCache()
    folder = cache.get(digest.hexdigest())
    if folder is not None:
        return dict(zip(pairs, json.loads((folder / _FILE).read_bytes()), strict=True))
    bodies = {
        name: [_body(assembly, drawn(shape.placed).mesh).transform(rest[name].matrix[:3]) for shape in shapes]
        for name, shapes in solids.items()
    }
    gaps = [min((float(one.min_gap(other, most)) for one in bodies[a] for other in bodies[b]), default=None) for a, b in pairs]
    with contextlib.suppress(ArticadError), cache.writing(digest.hexdigest()) as new:
        (new / _FILE).write_text(json.dumps(gaps))
    return dict(zip(pairs, gaps, strict=True))


def _is_solid(mesh: TriMesh) -> bool:
    return mesh.is_closed and mesh.volume > 0


def _body(assembly: Assembly, mesh: TriMesh) -> manifold3d.Manifold:
    return once(assembly, ("body", mesh.digest), lambda: manifold(mesh))
