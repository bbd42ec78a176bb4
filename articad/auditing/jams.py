"""Parts that jam in simulators: engines collide with convex hulls of meshes, and hulls can meet where the meshes are apart.

`articad.export.contacts` compares the hulls at rest and over each driver's range, the others at rest, which is also how `sim` drives them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from articad.assembly import Assembly
from articad.auditing.wording import listed
from articad.export.contacts import ContactSearch, poses_in_motion
from articad.export.hulls import HullOverlap, Pair, mating_pairs, rigid_groups, same_group_pairs
from articad.findings import Finding
from articad.geometry.capping import without_gaps

MOST_PARTS = 200  # with collision shapes
MOST_TRIANGLES = 200_000  # of all collision shapes
MOST_POSES = 1500
_NAMED = 4  # pairs in one message


def hull_jams(assembly: Assembly, filtered: frozenset[frozenset[str]] = frozenset()) -> tuple[list[Finding], list[str]]:
    """Return a finding for pairs whose hulls meet where their collision shapes do not, and what was not checked, in words.

    Engines skip pairs that a joint connects, unless one of them is fixed to the world. Small gaps of a mesh are closed for the comparison.
    Where a mesh is open for another reason, its hull, which is what engines use, is compared with the others' where its surface meets none
    of theirs.

    Args:
        assembly: Read from a URDF or MJCF file that articad did not write.
        filtered: Pairs that the file excludes from collision.
    """
    solids = {
        name: tuple(replace(shape, mesh=without_gaps(shape.mesh)) for shape in part.collisions)
        for name, part in assembly.parts.items()
        if part.collisions
    }
    open_ = [name for name, shapes in solids.items() if not all(shape.mesh.is_closed for shape in shapes)]
    undone = []
    if open_:
        undone = [f"hulls: the collision meshes of {listed(open_)} are open: a jam is not found where their surfaces touch others"]
    if len(solids) < 2:
        return [], undone
    triangles = sum(len(shape.mesh.triangles) for shapes in solids.values() for shape in shapes)
    if len(solids) > MOST_PARTS or triangles > MOST_TRIANGLES:
        return [], [
            *undone,
            f"hulls: {len(solids)} parts have collision shapes of {triangles} triangles; at most {MOST_PARTS} and {MOST_TRIANGLES} are compared",
        ]
    mechanism = assembly.mechanism
    search = ContactSearch(mechanism.parts, mechanism.at_rest[None].matrix, solids, surfaces=True)
    for name, shapes in solids.items():
        search.update(name, shapes)
    if search.is_convex:
        return [], undone
    search.poses = poses_in_motion(mechanism)[:MOST_POSES]
    found = [contact for contact in search.contacts(_never_collide(assembly, filtered)) if not contact.solids]
    return list(_findings(found)), undone


def _never_collide(assembly: Assembly, filtered: frozenset[frozenset[str]]) -> set[Pair]:
    """Return the pairs that engines do not compare: rigid ones, filtered ones, and neighbours of which none is fixed to the world."""
    joints, order = assembly.joints, assembly.mechanism.parts
    group = rigid_groups(joints, order)
    world = group[assembly.ground]
    skip = same_group_pairs(joints, order) | {(a, b) for a, b in mating_pairs(joints, order) if world not in {group[a], group[b]}}
    return skip | {(a, b) for a, b in (sorted(one) for one in filtered if len(one) == 2)}


def _findings(contacts: list[HullOverlap]) -> Iterator[Finding]:
    if not contacts:
        return
    worst = max(contacts, key=lambda contact: contact.depth)
    pairs = [f"{a} and {b}" for a, b in (contact.parts for contact in contacts)]
    yield Finding(
        code="W_AUDIT_HULL_JAM",
        where="parts." + "+".join(worst.parts),
        parts=worst.parts,
        message=f"Simulators collide with convex hulls, and those of {listed(pairs[:_NAMED])}"
        + (f" and of {len(pairs) - _NAMED} more pairs" if len(pairs) > _NAMED else "")
        + f" meet where the meshes are apart; the deepest overlap is {worst.depth:.3g} mm.",
        hint="Collide with convex pieces: articad audit FILE --fix OUT --collision pieces.",
        value=worst.depth,
        limit=0.0,
        unit="mm",
        cause="hull",
    )
