"""Pairs of parts: those that a joint connects, those that never move relative to each other, those whose hulls overlap."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import combinations

from articad.kinematics.joints import Joint, JointType

Pair = tuple[str, str]

HULL_DEPTH_MM = 0.02  # mean depth of an overlap that counts: at less depth hulls merely touch, as stacked parts do
HULL_VOLUME_MM3 = 1e-3  # rounding of a boolean


@dataclass(frozen=True)
class HullOverlap:
    """Two parts whose hulls overlap.

    Attributes:
        parts: The two parts, in the order in which they are declared.
        volume: Volume of the overlap [mm³].
        depth: Its mean thickness, twice the volume over the surface [mm].
        solids: True if the solids overlap as well, so that finer pieces do not help.
    """

    parts: Pair
    volume: float
    depth: float
    solids: bool = False


def mating_pairs(joints: tuple[Joint, ...], order: tuple[str, ...]) -> list[Pair]:
    """Return the pairs of parts that share a joint, once each, in the order of declaration, without free joints, which hold no contact."""
    rank = {part: index for index, part in enumerate(order)}
    pairs = {tuple(sorted((one.parent, one.child), key=rank.__getitem__)) for one in joints if one.type is not JointType.FREE}
    return sorted(((a, b) for a, b in pairs), key=lambda pair: (rank[pair[0]], rank[pair[1]]))


def rigid_groups(joints: tuple[Joint, ...], order: tuple[str, ...]) -> dict[str, int]:
    """Return for each part the number of its rigid group: parts joined by fixed joints only have the same one."""
    group = {part: index for index, part in enumerate(order)}
    members = {index: [part] for index, part in enumerate(order)}
    for joint in joints:
        old, new = group[joint.child], group[joint.parent]
        if joint.type is not JointType.FIXED or old == new:
            continue
        if len(members[old]) > len(members[new]):  # the smaller group is renumbered: each part at most log2(parts) times
            old, new = new, old
        group |= dict.fromkeys(members[old], new)
        members[new] += members.pop(old)
    return group


def same_group_pairs(joints: tuple[Joint, ...], order: tuple[str, ...]) -> set[Pair]:
    """Return the pairs of parts that never move relative to each other."""
    group, members = rigid_groups(joints, order), defaultdict[int, list[str]](list)
    for part in order:
        members[group[part]].append(part)
    return {pair for parts in members.values() for pair in combinations(parts, 2)}
