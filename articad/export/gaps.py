"""How far joined parts are apart at rest, kept in the cache of built parts by their shapes and poses."""

from __future__ import annotations

import contextlib
import hashlib
import json
from itertools import chain
from typing import TYPE_CHECKING, Final

import manifold3d

from articad.errors import ArticadError
from articad.export.convex import manifold
from articad.export.hulls import Pair, mating_pairs
from articad.export.meshes import SCHEME as DRAWN
from articad.export.meshes import drawn
from articad.export.once import once
from articad.geometry.mesh import TriMesh
from articad.kernels.cache import BuildCache

if TYPE_CHECKING:
    from articad.assembly import Assembly

TOUCHING_MM: Final = 1.0  # largest gap of two joined parts that touch by design; it includes the play of their fit
_SCHEME: Final = "articad.gaps/1"  # must change with how gaps are measured
_FILE: Final = "gaps.json"


def gaps_at_rest(assembly: Assembly) -> dict[Pair, float | None]:
    """Return the distances of joined parts at rest up to `TOUCHING_MM`, measured on the visual meshes; None where one has no solid.

    The cache of built parts keeps them by shapes and poses. A failure to write there is ignored.
    """
    pairs = mating_pairs(assembly.mechanism.joints, assembly.mechanism.parts)
    rest = assembly.mechanism.rest_poses()
    solids = {name: [shape for shape in assembly.parts[name].collisions if _is_solid(shape.mesh)] for name in chain.from_iterable(pairs)}
    digest = hashlib.sha256(f"{_SCHEME} {DRAWN} {TOUCHING_MM}".encode())
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
    gaps = [min((float(one.min_gap(other, TOUCHING_MM)) for one in bodies[a] for other in bodies[b]), default=None) for a, b in pairs]
    with contextlib.suppress(ArticadError), cache.writing(digest.hexdigest()) as new:
        (new / _FILE).write_text(json.dumps(gaps))
    return dict(zip(pairs, gaps, strict=True))


def _is_solid(mesh: TriMesh) -> bool:
    return mesh.is_closed and mesh.volume > 0


def _body(assembly: Assembly, mesh: TriMesh) -> manifold3d.Manifold:
    return once(assembly, ("body", mesh.digest), lambda: manifold(mesh))
