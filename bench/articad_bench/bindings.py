"""Bindings of a task's checks to bodies, derived from its reference.

What each joint that is asked for moves, which joints surfaces make, and, where a picture shows it, where parts lie and which hand it is;
of dimensioned sheets, each part's volume, holes and shoulders, and the fits.
The bounds are wide, because another construction of the same product is another share of its matter; a disc, a wire or a missing body is outside.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from articad.errors import ArticadError
from articad.kinematics.joints import JointType
from articad_bench.checks import AnyCheck, Joints, Lead, Made, Moves, Parts, Reaches, moved_shares
from articad_bench.likeness_checks import (
    DRAWN,
    PLACE,
    Arranged,
    Handed,
    Matter,
    Row,
    Upright,
    arrangement,
    filled,
    handedness,
    moments_of,
    turned_over,
)
from articad_bench.machined_checks import Machined, Toleranced, fits_stated, machined
from articad_bench.outline_checks import Outlined, outlined
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.whole_checks import Threads

__all__ = ["HANDED", "NotBoundError", "bindings", "bound", "bound_task", "shows_hands"]

VOLUME: Final = 5.0  # times less or more of the matter
GREATEST: Final = 2.5  # times less, for the joint that moves most, where proportions are shown
SIZE: Final = 2.0  # times smaller or larger, as a share of the whole
HAND: Final = 0.02  # by which the moments of mirror images differ, at least, where the whole has a hand
DETAIL: Final = 0.001  # by which they differ where a detail has one: less is the roughness of meshes
HANDED: Final = re.compile(
    r"(?<!\bis )(?<!\bare )(?<!\bbe )(?<!\bbeing )(?<!\bmm )\bleft\b(?! out)|\b(right|(anti|counter)?clockwise)\b", re.IGNORECASE
)
"""Words of a prompt that tell a product from its mirror image; what is left, or left out, is on no side."""
UP: Final = re.compile(
    r"\b(above|below|top|bottom|upper|lower|under|underside|upwards?|downwards?|up|down|stands?|standing|tip|foot|feet|floor|ground|hangs?)\b",
    re.IGNORECASE,
)
"""Words of a prompt that say which side is up."""
FACING: Final = re.compile(r"(?<!\w)[+-][xy]\b|\bx to the right\b|\bleft to right is x\b", re.IGNORECASE)
"""Words of a prompt that say which end of x or y something lies at."""
TURNED_OVER: Final = (0.06, 0.15)
"""By how much the moments of a product that is turned over differ, at least, where a picture shows it, and where a text alone says it."""
STRAIGHT: Final = frozenset({"front", "right", "top"})
"""Views that show the outlines along the three axes."""
BOUND: Final = (Moves, Made, Arranged, Outlined, Handed, Upright, Matter, Threads, Machined, Toleranced)


def bindings(task: Task, subject: Subject) -> tuple[AnyCheck, ...]:
    """Return checks that bind a task's joints to bodies.

    Args:
        task: The task.
        subject: Its reference.
    """
    checks: list[AnyCheck] = []
    for check in task.checks:
        if not isinstance(check, Joints) or check.joint.type is JointType.FIXED or check.number[0] < 1:
            continue
        shares = [moved[0] for joint in check.joint.found(subject) if (moved := moved_shares(subject, joint))]
        if not shares:
            continue
        volume, size = zip(*shares, strict=True)
        sizes = (_rounded(min(size) / SIZE), _rounded(max(size) * SIZE))
        all_of_them = (_rounded(min(volume) / VOLUME), min(1.0, _rounded(max(volume) * VOLUME)))
        checks.append(Moves(joint=check.joint, volume=all_of_them, size=sizes, number=check.number))
        if max(volume) > GREATEST * min(volume):
            less = GREATEST if task.images or task.given else VOLUME
            checks.append(Moves(joint=check.joint, volume=(_rounded(max(volume) / less), 1.0), size=sizes))
    moving, unmade = sum(joint.type is not JointType.FIXED for joint in subject.assembly.joints), len(subject.unmade)
    if unmade < moving:  # else the check could not fail
        checks.append(Made(except_for=unmade))
    share = filled(subject)
    checks.append(Matter(share=(_rounded(share / VOLUME), min(1.0, _rounded(share * VOLUME)))))
    left = [joint.lead < 0 for joint in subject.assembly.joints if joint.type is JointType.SCREW]
    stated = any(isinstance(check, Lead) and check.hand is not None for check in task.checks)
    if not stated and 2 * sum(left) != len(left):  # else its mirror image has the same threads
        checks.append(Threads(left=sum(left)))
    if _form(task) == "sheets":
        checks += [*machined(subject), *fits_stated(subject)]
    return (*checks, *_likeness(task, subject))


def _form(task: Task) -> str | None:
    return None if task.drawing is None else task.drawing.form


def _likeness(task: Task, subject: Subject) -> list[AnyCheck]:
    """Return checks of what a picture shows; which hand it is may be said in words as well."""
    checks: list[AnyCheck] = []
    count = len(subject.shaped)
    if task.images and count > 1 and any(isinstance(check, Parts) and check.number == (count, count) for check in task.checks):
        rows = arrangement(subject)
        place = DRAWN if _form(task) == "sheets" else PLACE
        checks.append(Arranged(parts=_rows(rows), loosely=_form(task) == "photos", place=place))
    elif task.images and _bodies_are_stated(task, subject):
        checks.append(Arranged(parts=_rows(arrangement(subject, bodies=True)), bodies=True, loosely=_form(task) == "photos"))
    if _shows_outlines(task):
        checks.append(outlined(subject))
    hand = handedness(subject) if shows_hands(task) else 0.0
    if hand > DETAIL:
        matter = tuple(round(value, 5 if hand <= HAND else 4) for value in moments_of(subject).tolist())
        loosely = hand <= HAND or _tells_sides(task)
        checks.append(Handed(matter=matter, margin=_rounded(hand / 2) if loosely else 0.0))
    return [*checks, *_standing(task, subject)]


def _shows_outlines(task: Task) -> bool:
    """Return whether pictures show the outlines along the three axes; sheets hold each part to its own drawing."""
    if task.drawing is None or not task.images:
        return False
    return task.drawing.form == "photos" or (task.drawing.form == "overview" and {*task.drawing.views} >= STRAIGHT)


def _standing(task: Task, subject: Subject) -> list[AnyCheck]:
    """Return the check of which side is up, and which is the front, where a picture or words say it and the reference is another product turned over."""
    if task.given is not None:
        return []
    matter, least = moments_of(subject), TURNED_OVER[0 if task.images else 1]
    _, over, half = turned_over(subject, matter, faces=True)
    upright = over if task.images or UP.search(task.prompt) else 0.0
    facing = half if FACING.search(task.prompt) else 0.0
    margins = [_rounded(differs / 2) if differs > least else None for differs in (upright, facing)]
    if margins == [None, None]:
        return []
    return [Upright(matter=tuple(round(value, 4) for value in matter.tolist()), over=margins[0], half=margins[1])]


def _tells_sides(task: Task) -> bool:
    """Return whether the sides to which a product moves tell its hand: without a picture, how its matter lies is then its maker's choice."""
    return not task.images and task.given is None and any(isinstance(check, Reaches) for check in task.checks)


def _rows(rows: Sequence[Row]) -> tuple[Row, ...]:
    return tuple(tuple(round(value, 4) for value in row) for row in rows)  # type: ignore[misc]


def _bodies_are_stated(task: Task, subject: Subject) -> bool:
    """Return whether the joints asked for, with their numbers, are all that the reference has: then any solution has the same bodies."""
    wanted = [check for check in task.checks if isinstance(check, Joints) and check.joint.type is not JointType.FIXED]
    moving = sum(joint.type is not JointType.FIXED for joint in subject.assembly.joints)
    return all(check.number[0] == check.number[1] for check in wanted) and sum(int(check.number[0]) for check in wanted) == moving > 0


def shows_hands(task: Task) -> bool:
    """Return whether a picture or a word of a task tells the product from its mirror image."""
    return bool(task.images or HANDED.search(task.prompt))


def bound(task: Task, subject: Subject) -> Task:
    """Return a task with its bindings in place of those that it has."""
    others = tuple(check for check in task.checks if not isinstance(check, BOUND))
    return task.model_copy(update={"checks": (*others, *bindings(task, subject))})


class NotBoundError(ArticadError):
    """A reference does not pass the checks that are derived from it."""


def bound_task(task: Task, subject: Subject, after: Sequence[Subject] = ()) -> Task:
    """Return a task with its bindings in place of those that it has; an edit restates those that do not hold of the edited product, or of its mirror image as well.

    It also restates outlines that lie as far apart as a third of what is allowed: who makes the edit must have the same margin.

    Args:
        task: The task.
        subject: Its reference.
        after: Its reference after each edit.

    Raises:
        NotBoundError: If a reference does not pass; says which checks.
    """
    found = bound(task, subject)
    held = [check for check in found.checks if isinstance(check, BOUND)]
    _all_hold(held, subject)
    edits = []
    for edit, checks, product in zip(task.edits, task.stages[1:], after, strict=True):
        kinds = {check.kind for check in held if not check.judge(product).ok}
        kinds |= {check.kind for check in held if isinstance(check, Handed) and not check.refuses_mirror_image(product)}
        kinds |= {check.kind for check in held if isinstance(check, Outlined) and check.apart(product) > check.beside / 3}
        again = [check for check in bindings(task.model_copy(update={"checks": checks}), product) if check.kind in kinds]
        _all_hold(again, product)
        held = [*(check for check in held if check.kind not in {each.kind for each in again}), *again]
        others = (check for check in edit.checks if not isinstance(check, BOUND))
        edits.append(edit.model_copy(update={"checks": (*others, *again)}))
    return found.model_copy(update={"edits": tuple(edits)})


def _all_hold(checks: Sequence[AnyCheck], subject: Subject) -> None:
    wrong = [each for each in (check.judge(subject) for check in checks) if not each.ok]
    if wrong:
        raise NotBoundError("; ".join(f"{each.kind} wants {each.wanted}, is {each.measured}" for each in wrong))


def _rounded(value: float) -> float:
    return float(f"{value:.2g}")
