"""Cheats on tasks that begin with a product, or go on after it: what was there already is the answer, or all but one of the changes.

They are made of the product that is given and of the reference at each stage.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np

from articad.assembly import Assembly
from articad.certificates.certificate import constrained_joints
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box
from articad.kinematics import Coupling, Joint
from articad.kinematics.joints import JointLimits, JointType
from articad_bench.subject import Subject

__all__ = ["STAGED", "StagedCheat", "alike", "of_the_same", "staged_cheats"]

STAGED: Final = ("given", "short", "stage", "partly", "side", "crumbs")
"""Kinds of these cheats."""
CRUMB_MM: Final = 1.5
HAIR: Final = 1e-5  # share of its size by which a part is larger
OTHER_SIDE: Final = 0.03  # of a side of a part, by which it must have changed


@dataclass(frozen=True)
class StagedCheat:
    """A product that must not pass at a stage of a task.

    Attributes:
        kind: One of `STAGED`, or of `articad_bench.cheats`.
        what: Which of several of its kind it is.
        stage: Where it is the answer: 0, or the number of an edit.
        before: The product before, as it should be.
        right: The product that is asked for.
        make: Returns the cheat; None if the task cannot be tried with it.
    """

    kind: str
    what: str
    stage: int
    before: Assembly | None
    right: Assembly
    make: Callable[[], Assembly | None]


def staged_cheats(begun: Assembly | None, stages: Sequence[Assembly], left_open: Collection[str] = ()) -> Iterator[StagedCheat]:
    """Yield what may be left undone.

    Args:
        begun: The product that a task begins with, if it does.
        stages: The reference at first, and after each edit.
        left_open: Names of parts, or of their sides, that need not change.
    """
    products = [begun, *stages]
    for stage, right in enumerate(stages):
        before = products[stage]
        put = partial(StagedCheat, stage=stage, before=before, right=right)
        for number, product in enumerate(products, start=-1):
            if product is None or number == stage:
                continue
            first = number < 0 and stage == 0
            what = "" if first else f"{_named(number)} in place of {_named(stage)}"
            yield put("given" if first else "stage", what, make=partial(_itself, product))
        for what, make in _partly(before, right):
            if what in left_open:
                continue
            yield put("partly", f"{_named(stage)} with {what} as before", make=make)
        for name, what, make in _sides(before, right):
            if not {name, what} & {*left_open}:
                yield put("side", f"{_named(stage)} with {what} as before", make=make)
        if begun is None and before is not None:
            kept = _kept(before, right)
            yield replace(put("crumbs", "", make=partial(_all_new, right, kept)), before=_with_crumbs(before, kept))
    if begun is not None:
        yield StagedCheat("short", "", 0, begun, stages[0], partial(_short, stages[0]))


def alike(first: Assembly, second: Assembly) -> bool:
    """Return whether two products have the same shapes and move alike, under the same names.

    In a loop or a coupling, other joints may decide where one rests and how far it goes; then its own numbers for that do not matter.
    """
    shapes = [{name: part.mesh and part.mesh.digest for name, part in each.parts.items()} for each in (first, second)]
    joints = [{joint.name: joint for joint in each.joints} for each in (first, second)]
    if shapes[0] != shapes[1] or joints[0].keys() != joints[1].keys() or first.mechanism.couplings != second.mechanism.couplings:
        return False
    changed = {name for name, joint in joints[0].items() if joint != joints[1][name]}
    if not changed:
        return True
    led = changed <= constrained_joints(first.mechanism) and all(_connect_alike(joints[0][name], joints[1][name]) for name in changed)
    return led and _go_as_far(first, second)


def _connect_alike(one: Joint, other: Joint) -> bool:
    """Return whether two joints differ at most in where they rest and how far they go."""
    kinds = [(each.type, each.parent, each.child, each.mate, each.lead, each.driver) for each in (one, other)]
    return (
        kinds[0] == kinds[1]
        and one.T_parent_connector.allclose(other.T_parent_connector)
        and one.T_child_connector.allclose(other.T_child_connector)
    )


def _go_as_far(first: Assembly, second: Assembly) -> bool:
    """Return whether two products rest alike, and their drivers have the same names and go as far."""
    subjects = [Subject(each) for each in (first, second)]
    at_rest = [each.poses(np.array(each.mechanism.rest)) for each in (first, second)]
    names = [[coordinate.name for coordinate in each.drivers] for each in (first, second)]
    if names[0] != names[1] or not at_rest[0].allclose(at_rest[1], mm=1e-3, rad=1e-5):
        return False
    ranges = ([subject.driver_range(name) for subject in subjects] for name in names[0])
    return all(one == other or (one is not None and other is not None and np.allclose(one, other)) for one, other in ranges)


def _named(number: int) -> str:
    return "what is given" if number < 0 else "the first product" if number == 0 else f"edit {number}"


def _itself(product: Assembly) -> Assembly:
    return product


def _short(after: Assembly) -> Assembly:
    """Return a product whose joints go half as far from rest: so they do not come to what is in the way."""

    def narrowed(joint: Joint) -> Joint:
        lower, upper = (
            [(end + rest) / 2 for end, rest in zip(ends, joint.rest, strict=True)] for ends in (joint.limits.lower, joint.limits.upper)
        )
        return replace(joint, limits=replace(joint.limits, lower=tuple(lower), upper=tuple(upper)))

    joints = [narrowed(joint) if joint.limits.lower else joint for joint in after.joints]
    return _moving(after, joints, after.mechanism.couplings)


def _partly(before: Assembly | None, after: Assembly) -> list[tuple[str, Callable[[], Assembly]]]:
    """Return what makes products in which one change of several was not made: of a part's shape, of a joint, of the couplings.

    Of parts that have changed in the same way, one is left as it was.
    """
    if before is None:
        return []
    found: dict[object, tuple[str, Callable[[], Assembly]]] = {}
    for name, part in after.parts.items():
        old = before.parts.get(name)
        if old is not None and old.mesh is not None and part.mesh is not None and old.mesh.digest != part.mesh.digest:
            found.setdefault((old.mesh.digest, part.mesh.digest), (name, partial(_with_part, after, before, name)))
    joints = {joint.name: joint for joint in before.joints}
    for joint in after.joints:
        if joint.name in joints and joints[joint.name] != joint:
            found[joint.name] = (f"joint {joint.name}", partial(_with_joint, after, before, joint.name))
    if before.mechanism.couplings != after.mechanism.couplings:
        found[()] = ("the couplings", partial(_with_couplings, after, before))
    return list(found.values()) if len(found) > 1 else []


def _sides(before: Assembly | None, after: Assembly) -> Iterator[tuple[str, str, Callable[[], Assembly]]]:
    """Yield the name of each part of which several sides have changed, and what makes products in which one of these is as long as it was.

    Of parts that have changed in the same way, one is stretched.
    """
    known = set()
    for name, part in after.parts.items():
        old = None if before is None else before.parts.get(name)
        if old is None or old.mesh is None or part.mesh is None or (key := (old.mesh.digest, part.mesh.digest)) in known:
            continue
        known.add(key)
        factors = np.ptp(old.mesh.bounds, axis=0) / np.ptp(part.mesh.bounds, axis=0)
        changed = [axis for axis in range(3) if abs(factors[axis] - 1) > OTHER_SIDE]
        for axis in changed if len(changed) > 1 else ():
            yield name, f"{name} along {'xyz'[axis]}", partial(_stretched, after, name, axis, float(factors[axis]))


def _stretched(after: Assembly, name: str, axis: int, factor: float) -> Assembly:
    """Return a product with a part that is stretched about the middle of its box along an axis of its own frame."""
    part = after.parts[name]
    if part.mesh is None:
        return after
    middle = part.mesh.bounds.mean(axis=0)
    vertices = middle + (part.mesh.vertices - middle) * np.where(np.arange(3) == axis, factor, 1.0)
    return replace(after, parts={**after.parts, name: of_the_same(part, TriMesh(vertices, part.mesh.triangles))})


def _with_part(after: Assembly, before: Assembly, name: str) -> Assembly:
    return replace(after, parts={**after.parts, name: before.parts[name]})


def _with_joint(after: Assembly, before: Assembly, name: str) -> Assembly:
    (old,) = (joint for joint in before.joints if joint.name == name)
    return _moving(after, [old if joint.name == name else joint for joint in after.joints], after.mechanism.couplings)


def _with_couplings(after: Assembly, before: Assembly) -> Assembly:
    return _moving(after, after.joints, before.mechanism.couplings)


def _moving(after: Assembly, joints: Sequence[Joint], couplings: Sequence[Coupling]) -> Assembly:
    return replace(after, mechanism=after.mechanism.changed(joints=joints, couplings=couplings))


def _kept(before: Assembly, after: Assembly) -> int:
    """Return how many parts have the shape of one from before."""
    shapes = [Counter(part.mesh.digest for part in each.parts.values() if part.mesh is not None) for each in (before, after)]
    return (shapes[0] & shapes[1]).total()


def _all_new(after: Assembly, crumbs: int) -> Assembly:
    """Return a product whose parts are all a hair larger, with crumbs."""
    parts = {name: _larger(part) for name, part in after.parts.items()}
    return _with_crumbs(replace(after, parts=parts), crumbs)


def _larger(part: Part) -> Part:
    if part.mesh is None:
        return part
    return of_the_same(part, part.mesh.scaled(1 + HAIR))


def of_the_same(part: Part, mesh: TriMesh) -> Part:
    """Return a part of another shape, of the same stuff."""
    density = 1e9 * part.mass.mass / abs(part.mesh.volume) if part.mass is not None and part.mesh is not None else None
    return replace(Part.from_mesh(part.name, mesh, density=density), color=part.color)


def _with_crumbs(assembly: Assembly, number: int) -> Assembly:
    """Return a product with crumbs one below the other, the first under the lowest corner of the ground."""
    mesh, mechanism = assembly.parts[assembly.ground].mesh, assembly.mechanism
    if mesh is None:
        return assembly
    corner = mesh.vertices[mesh.vertices[:, 2].argmin()]
    names = [f"crumb_{i}" for i in range(number)]
    crumbs = [Part.from_mesh(name, box(CRUMB_MM, CRUMB_MM, CRUMB_MM), density=1000.0) for name in names]
    joints = [
        Joint(
            name=f"{name}_held",
            type=JointType.FIXED,
            parent=assembly.ground,
            child=name,
            parent_connector=f"{name}_p",
            child_connector=f"{name}_c",
            T_parent_connector=SE3.from_translation(corner - np.array([0.0, 0.0, (i + 0.5) * CRUMB_MM])),
            T_child_connector=SE3.identity(),
            limits=JointLimits(),
            rest=(),
        )
        for i, name in enumerate(names)
    ]
    return Assembly.from_parts(
        assembly.name,
        parts=[*assembly.parts.values(), *crumbs],
        joints=[*assembly.joints, *joints],
        ground=assembly.ground,
        couplings=mechanism.couplings,
        fits=assembly.fits,
        T_ground=mechanism.T_ground,
    )
