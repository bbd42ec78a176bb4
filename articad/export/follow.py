"""Which freedoms follow which: couplings and screws as linear relations to one leader, and chains where a URDF file states them."""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import TYPE_CHECKING

from articad.export.lowering import AxisMotion, Follows, LoweredModel

if TYPE_CHECKING:
    from articad.assembly import Assembly


STATES_MIMIC = "<mimic/>"  # what is kept with a joint whose URDF file states what it follows


def leaders(assembly: Assembly) -> list[str]:
    """Return the columns that lead the others, best first: those that a foreign file calls leaders, then the drivers."""
    couplings = assembly.mechanism.couplings if assembly.foreign else ()
    tied = {coupling.b for coupling in couplings}
    stated = [coupling.a for coupling in couplings if coupling.a not in tied]
    return list(dict.fromkeys([*stated, *(driver.name for driver in assembly.mechanism.drivers)]))


def as_stated(follows: dict[str, Follows], model: LoweredModel, stated: Container[str]) -> dict[str, Follows]:
    """Return the relations; those that a file states keep the file's form, in which a follower may lead others.

    Args:
        follows: What each tied freedom follows.
        model: Its couplings.
        stated: Places such as `couplings.a_follows_b`.
    """
    chains = {name: relation for coupling, name, relation in model.couplings if f"couplings.{coupling}" in stated and name in follows}
    return follows | chains


def followers(model: LoweredModel, leaders: Iterable[str]) -> dict[str, Follows]:
    """Return the leader of each coupled freedom of the tree; leaders follow nothing, so no chain has two steps.

    Args:
        model: Freedoms and the relations between them.
        leaders: Columns requested as leaders, best first; otherwise the first freedom of the tree leads.
    """
    freedoms: dict[str, AxisMotion] = {freedom.name: freedom for joint in model.joints for freedom in joint.freedoms}
    relations = [(name, follows) for _, name, follows in model.couplings]
    relations += [(freedom.name, freedom.follows) for freedom in freedoms.values() if freedom.follows is not None]
    neighbours: dict[str, list[Follows]] = {}
    for name, follows in relations:
        neighbours.setdefault(follows.leader, []).append(Follows(name, 1 / follows.ratio, -follows.offset / follows.ratio))
        neighbours.setdefault(name, []).append(follows)
    by_column = {freedom.column: name for name, freedom in freedoms.items() if freedom.column is not None}
    order = [by_column[column] for column in leaders if column in by_column] + list(freedoms)
    found: dict[str, Follows] = {}
    reached: set[str] = set()
    for leader in order:
        if leader in reached or leader not in neighbours:
            continue
        reached.add(leader)
        queue = [(leader, 1.0, 0.0)]
        for name, ratio, offset in queue:  # value(name) = ratio · value(leader) + offset
            for relation in neighbours[name]:
                if relation.leader in reached:
                    continue
                # value(name) = k · value(other) + c, solved for the other
                k, c = relation.ratio, relation.offset
                other = (relation.leader, ratio / k, (offset - c) / k)
                reached.add(relation.leader)
                queue.append(other)
                found[relation.leader] = Follows(leader, other[1], other[2])
    return {name: follows for name, follows in found.items() if name in freedoms}
