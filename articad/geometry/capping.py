"""Small gaps of a surface, closed by fans: many meshes of robots enclose a solid but for a few slits."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import Final, cast

import numpy as np

from articad.geometry.mesh import TriMesh

GAP_SHARE: Final = 0.05  # of the surface: caps with more area would fill an opening that is meant


def capped(mesh: TriMesh, most: float = GAP_SHARE) -> TriMesh | None:
    """Return a mesh with its gaps closed, or None if the caps are large or the result encloses nothing.

    Each triangle contributes a cycle of directed edges, so the edges without a partner form cycles as well. Each of these gets triangles from
    its mean point to its edges, in the opposite direction.

    Args:
        mesh: An open surface.
        most: Largest area of all caps, as a share of the surface.
    """
    welded = mesh.welded()
    ends = welded.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()
    balance = Counter((a, b) for a, b in ends)
    balance.subtract((b, a) for a, b in ends)
    onward: defaultdict[int, list[int]] = defaultdict(list)
    for (a, b), count in sorted(balance.items()):
        onward[a] += [b] * max(count, 0)
    vertices, caps = [welded.vertices], []
    middle = len(welded.vertices)
    for cycle in _cycles(onward):
        vertices.append(welded.vertices[cycle].mean(axis=0)[None])
        caps += [(after, before, middle) for before, after in zip(cycle, [*cycle[1:], cycle[0]], strict=True)]
        middle += 1
    if not caps:
        return None
    added = TriMesh(np.concatenate(vertices), np.array(caps, dtype=np.int32))
    closed = TriMesh(added.vertices, np.concatenate([welded.triangles, added.triangles]))
    return closed if added.area <= most * welded.area and closed.is_closed and closed.volume > 0 else None


def without_gaps(mesh: TriMesh) -> TriMesh:
    """Return a mesh with small gaps closed, or as it is if it is closed or open for another reason; kept with the mesh."""
    if mesh.is_closed:
        return mesh
    found = mesh.derived.get("capped")
    if found is None:
        found = mesh.derived["capped"] = capped(mesh) or mesh
    return cast("TriMesh", found)


def _cycles(onward: dict[int, list[int]]) -> list[list[int]]:
    """Return the cycles of a graph whose vertices have as many edges in as out, each through a vertex once; the edges are used up."""
    found = []
    for start in sorted(onward):
        path, place = [start], {start: 0}
        while onward.get(path[-1]):
            vertex = onward[path[-1]].pop()
            if vertex in place:
                at = place[vertex]
                found.append(path[at:])
                for left in path[at + 1 :]:
                    del place[left]
                path = path[: at + 1]
            else:
                place[vertex] = len(path)
                path.append(vertex)
    return found
