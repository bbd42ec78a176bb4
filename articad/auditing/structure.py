"""Whether the file is a mechanism at all: unique names, joints between existing links, one root, no cycle."""

from __future__ import annotations

from collections.abc import Iterator

from articad.auditing.declared import MOVING, Declared
from articad.auditing.wording import counted, listed
from articad.errors import did_you_mean
from articad.findings import Finding

MOST_GUESSES = 20  # suggestions for wrong names: each compares with all names


def repeated_names(declared: Declared) -> Iterator[Finding]:
    """Two links or two joints with the same name."""
    for kind, items in (("links", declared.links), ("joints", declared.joints)):
        places: dict[str, list[str]] = {}
        for item in items:
            places.setdefault(item.name, []).append(item.where)
        for name, found in places.items():
            if (count := len(found)) > 1:
                yield Finding(
                    code="E_AUDIT_NAME_TWICE",
                    where=f"{kind}.{name}",
                    parts=(name,),
                    message=f"{count} {kind} have the name {name!r}: {', '.join(found)}.",
                    hint="Rename all but one, and update references to them.",
                    value=count,
                    limit=1,
                )


def unknown_links(declared: Declared) -> Iterator[Finding]:
    """A joint that names a missing link."""
    asked = 0
    for joint in declared.joints:
        for side, link in (("parent", joint.parent), ("child", joint.child)):
            if link not in declared.by_name:
                asked += 1
                meant = did_you_mean(link, declared.by_name) if asked <= MOST_GUESSES else ""
                yield Finding(
                    code="E_AUDIT_LINK_UNKNOWN",
                    where=joint.where,
                    parts=(link,),
                    message=f"The {side} of joint {joint.name!r} is {link!r}, but no link has this name.{meant}",
                    hint=f"Name one of the {len(declared.by_name)} links, or add a link {link!r} and a joint that carries it."
                    if side == "parent"
                    else f"Name one of the {len(declared.by_name)} links, or add a link {link!r}.",
                )


def unknown_kinds(declared: Declared) -> Iterator[Finding]:
    """A joint of a type that the format does not have."""
    for joint in declared.joints:
        if joint.type not in {"fixed", *MOVING} - {"screw"}:
            yield Finding(
                code="E_AUDIT_JOINT_TYPE",
                where=joint.where,
                message=f"Joint {joint.name!r} is of type {joint.type!r}.{did_you_mean(joint.type, MOVING)}",
                hint="Use fixed, revolute, continuous, prismatic, planar or floating.",
            )


def carried_twice(declared: Declared) -> Iterator[Finding]:
    """A link that two joints carry: a closed loop, which URDF cannot hold."""
    carried: dict[str, list[str]] = {}
    for joint in declared.joints:
        carried.setdefault(joint.child, []).append(joint.name)
    for link, carriers in carried.items():
        if (count := len(carriers)) > 1 and link in declared.by_name:
            yield Finding(
                code="E_AUDIT_TWO_PARENTS",
                where=f"links.{link}",
                parts=(link,),
                message=f"Link {link!r} is the child of {counted(count, 'joint')}: {listed(carriers)}.",
                hint="Keep one of them; a closed loop needs a format with loops, such as MJCF.",
                value=count,
                limit=1,
            )


def roots(declared: Declared) -> Iterator[Finding]:
    """No link, or several links, that no joint carries."""
    found = declared.roots
    if len(found) == 1 or not declared.links:
        return
    if not found:
        message = f"Every one of the {len(declared.by_name)} links is the child of a joint: the joints form a cycle."
        hint = "Remove the joint that closes the cycle."
    else:
        message = f"{len(found)} links are not the child of any joint: {listed(found)}. All but one of them are not connected."
        hint = "Connect each of them with a joint, or remove it."
    yield Finding(
        code="E_AUDIT_ROOTS",
        where="joints",
        parts=found if len(found) < 50 else found[:50],
        message=message,
        hint=hint,
        value=len(found),
        limit=1,
    )


def circles(declared: Declared) -> Iterator[Finding]:
    """Joints that form a cycle in addition to a root."""
    parents = {joint.child: joint for joint in declared.joints if joint.parent in declared.by_name}
    if not declared.roots:
        return  # `roots` reports it
    done: set[str] = set(declared.roots)
    for start in parents:
        path: list[str] = []
        link = start
        while link not in done and link in parents:
            done.add(link)
            path.append(link)
            link = parents[link].parent
        if link in path:
            circle = path[path.index(link) :]
            yield Finding(
                code="E_AUDIT_CIRCLE",
                where=parents[link].where,
                parts=tuple(circle),
                message=f"The links {listed(circle)} form a cycle.",
                hint=f"Let one of the joints between them, such as {parents[link].name!r}, start from a link outside the cycle.",
                value=len(circle),
                limit=0,
            )


def unknown_leaders(declared: Declared) -> Iterator[Finding]:
    """A mimic of a joint that is missing, or does not move."""
    moving = {joint.name for joint in declared.joints if joint.moves}
    asked = 0
    for joint in declared.joints:
        if joint.mimics is not None and (joint.mimics not in moving or joint.mimics == joint.name):
            asked += 1
            meant = did_you_mean(joint.mimics, moving - {joint.name}) if asked <= MOST_GUESSES else ""
            what = "itself" if joint.mimics == joint.name else f"{joint.mimics!r}, which is not a moving joint"
            yield Finding(
                code="E_AUDIT_MIMIC",
                where=joint.where,
                message=f"Joint {joint.name!r} mimics {what}.{meant}",
                hint="Name a joint that moves, or remove the mimic.",
            )


CHECKS = (repeated_names, unknown_links, unknown_kinds, carried_twice, roots, circles, unknown_leaders)
