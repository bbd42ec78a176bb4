"""Variants of tasks: a seed gives a task other numbers, a drawing and checks of its own, so that no answer that leaked fits.

One or two numbers of the reference's plan that the text states get other values: parameters, or dimensions of parts. Each check that the new reference does not meet gets
new numbers: its own, moved or stretched as the parameters were, by the first way in which it holds. The text follows the checks. A variant
counts only if its reference, made again from its files, passes every check, its table of sentences is complete, and the reference of the
original task fails.
"""

from __future__ import annotations

import math
import random
import shutil
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice, pairwise, product
from pathlib import Path
from typing import Any, Final

from pydantic import TypeAdapter

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.kernels.kernel import BuildCache, PartKernel
from articad.plan.amending import amended
from articad.plan.check import admitted
from articad.plan.fields import lengths_in
from articad.plan.schema import PLAN_FILE, AssemblyPlan
from articad.processes import scratch
from articad_bench.bindings import BOUND, NotBoundError, bound_task
from articad_bench.cheat_run import refused_by
from articad_bench.checks import AnyCheck
from articad_bench.pictures import is_drawn, pictures_of
from articad_bench.reference import reference, reference_folder, references
from articad_bench.sentences import Number, edit_text, holds, numbers_of, sentences, stage_of, texts_of
from articad_bench.subject import Subject
from articad_bench.task import Task, as_stored

__all__ = ["NoVariantError", "Variant", "make_variant"]

LEAST: Final = 5.0  # mm, degrees or a number: smaller values are plays and thicknesses
FACTORS: Final = (0.06, 0.15)  # by how much a value changes, at least and at most
TRIES: Final = 8  # draws of parameters for one task
COMBINATIONS: Final = 400  # of numbers for one check
NARROW: Final = 0.2  # of a number: bounds so close together are those of one number
EXACT: Final = 0.02  # of a tolerance: a number that holds so closely is the one that is meant
COSTLY: Final = {
    "holes": 60,
    "studs": 60,
    "square": 20,
    "section": 60,
    "wall": 20,
    "gap": 20,
    "clear_in_motion": 0,
    "certified": 0,
    "captive": 0,
    "simulates": 0,
    "put_together": 0,
    "effort": 0,
    "carries": 20,
    "folds": 20,
    "stack": 20,
}
UNITS: Final = {"mm": "mm", "deg": "deg", "1": "count"}

_Change = tuple[float, float]
"""A parameter's value before and after."""


class NoVariantError(ArticadError):
    """No number of a task's reference can be given another value; says which were tried, and why the last one failed."""


@dataclass(frozen=True)
class Variant:
    """A task that was made of another.

    Attributes:
        folder: Where it is.
        task: The task.
        changed: Numbers of its reference's plan, each with its value before and after.
    """

    folder: Path
    task: Task
    changed: dict[str, _Change]


def make_variant(
    folder: Path, task: Task, seed: int, out: Path, *, cache: BuildCache | None = None, kernel: PartKernel | None = None
) -> Variant:
    """Write the variant of a task that a seed gives, with its reference and drawing, to a folder of the task's name.

    Args:
        folder: Of the task.
        task: The task.
        seed: The same seed gives the same variant.
        out: Where the folder is made. One that is there is not replaced.
        cache: Keeps built parts.
        kernel: Builds the references; what their plans name by default.

    Raises:
        NoVariantError: If no draw of parameters gives one, or the folder is there already.
        ArticadError: If the task has no reference, or it does not build.
    """
    if any(edit.reference is not None for edit in task.edits):
        raise NoVariantError(f"{task.name}: another plan makes an edit.")
    if task.given is not None:
        raise NoVariantError(f"{task.name}: it begins with a product, whose numbers stay.")
    target = out / task.name
    if target.exists():
        raise NoVariantError(f"{task.name}: {target} is there already, and is not replaced. Name another folder.")
    place = reference_folder(folder, task)
    plan = AssemblyPlan.load(place)
    free = _free_numbers(task, plan)
    if not free:
        raise NoVariantError(f"{task.name}: its text states no number that its reference has alone.")
    draw, wrong = random.Random(f"{task.name} {seed}"), ""  # noqa: S311 (nothing is kept secret by it)
    original: Assembly | None = None
    for attempt in range(TRIES):
        names = draw.sample(list(free), min(len(free), 2 if 2 * attempt < TRIES else 1))
        values = _drawn([free[name] for name in names], draw)
        try:
            new = AssemblyPlan.from_json(
                amended(plan.to_json(), {at: value for name, value in values.items() for at in free[name].addresses})
            )
            admitted(new)
            original = original or reference(folder, task, cache=cache, kernel=kernel)
            changed = {name: (free[name].value, value) for name, value in values.items()}
            with scratch.folder_beside(target) as made:
                told = _made(folder, task, new, changed, original, made, cache, kernel)
            return Variant(target, told, changed)
        except ArticadError as error:
            wrong = f"{', '.join(f'{name} {value:g}' for name, value in values.items())}: {str(error).splitlines()[0]}"
    raise NoVariantError(f"{task.name}: no draw of {', '.join(free)} gives a task; the last one, {wrong}")


def _made(
    folder: Path,
    task: Task,
    plan: AssemblyPlan,
    changed: dict[str, _Change],
    original: Assembly,
    target: Path,
    cache: BuildCache | None,
    kernel: PartKernel | None,
) -> Task:
    changes = list(changed.values())
    fresh, stages = task.model_copy(update={"reference": "reference"}), [changed]
    for number, edit in enumerate(task.edits):
        values = {name: value * changed[name][1] / changed[name][0] if name in changed else value for name, value in edit.values.items()}
        values = {name: _near(value) if name in changed else value for name, value in values.items()}
        stages.append({name: (edit.values.get(name, old), values.get(name, new)) for name, (old, new) in stages[-1].items()})
        fresh = _with_edit(fresh, number, values=values)
    _write_reference(plan, reference_folder(folder, task), target / "reference")
    products = list(references(target, fresh, cache=cache, kernel=kernel))
    subject = Subject(products[0])
    after = [Subject(product, before=before) for before, product in pairwise(products)]
    fresh = fresh.model_copy(update={"checks": _following(_unbound(task.checks), subject, changes)})
    for number, (edit, edited) in enumerate(zip(task.edits, after, strict=True)):
        fresh = _with_edit(fresh, number, checks=_following(_unbound(edit.checks), edited, list(stages[number + 1].values())))
        _hold(_unbound(fresh.stages[number + 1]), edited)
    fresh = _worded(task, fresh, [list(stage.values()) for stage in stages])
    _told(fresh)
    if refused_by(fresh, Subject(original)) is None:
        raise NoVariantError("the original reference passes")
    try:
        fresh = bound_task(fresh, subject, after)
    except NotBoundError as error:
        raise NoVariantError(str(error)) from error
    if fresh.drawing is not None and is_drawn(fresh):
        for name, content in pictures_of(products[0], fresh.drawing).items():
            scratch.write(target / name, content)
    scratch.write(target / "task.json", as_stored(fresh))
    return fresh


def _with_edit(task: Task, number: int, **changes: Any) -> Task:
    """Return a task of which one edit, counted from 0, says something else."""
    edits = list(task.edits)
    edits[number] = edits[number].model_copy(update=changes)
    return task.model_copy(update={"edits": tuple(edits)})


COMMON: Final = "parts.py"  # builds the parts that have no script of their own


def _write_reference(plan: AssemblyPlan, source: Path, target: Path) -> None:
    target.mkdir(parents=True)
    plan.save(target / PLAN_FILE)
    if (source / "parts").is_dir():
        shutil.copytree(source / "parts", target / "parts", ignore=shutil.ignore_patterns("__pycache__"))
    if (source / COMMON).is_file():
        shutil.copyfile(source / COMMON, target / COMMON)


def _hold(checks: Sequence[AnyCheck], subject: Subject) -> None:
    """Raise unless a reference passes."""
    for check in checks:
        judged = check.judge(subject)
        if not judged.ok:
            raise NoVariantError(f"{judged.kind} wants {judged.wanted}, is {judged.measured}")


def _told(task: Task) -> None:
    """Raise unless every number is held, and every check stated."""
    table = sentences(task)
    wrong = [f"no check holds {row.number.value:g} of: {row.number.sentence}" for row in table.numbers if not row.held]
    wrong += [f"nothing states {row.check}" for row in table.checks if row.stated is None]
    wrong += [f"a mark holds no number: {mark}" for mark in table.stale]
    if wrong:
        raise NoVariantError(wrong[0])


# ---------------------------------------------------------------------- parameters


@dataclass(frozen=True)
class _Free:
    """A number of a reference's plan that may change: a parameter, or a dimension that is a number, in all parts that share it."""

    name: str
    value: float
    unit: str
    addresses: tuple[str, ...]
    bounds: tuple[float, float] = (-math.inf, math.inf)


def _free_numbers(task: Task, plan: AssemblyPlan) -> dict[str, _Free]:
    """Return the numbers whose values the task's texts state, and which are no other number's values as well.

    A task without a prompt is asked by its drawing, which shows whatever number is chosen.
    """
    stated = {(number.unit, number.value) for number in numbers_of(task) if _figures(task, number)}
    every = [*_parameters(plan), *_dimensions(plan)]
    taken = Counter((each.unit, each.value) for each in every)
    alone = [each for each in every if each.value >= LEAST and taken[each.unit, each.value] == 1]
    found = {each.name: each for each in alone if {(each.unit, each.value), ("count", each.value)} & stated}
    return found if found or task.prompt else {each.name: each for each in alone}


def _parameters(plan: AssemblyPlan) -> Iterator[_Free]:
    for each in plan.parameters:
        if isinstance(each.value, int | float):
            low, high = (end if isinstance(end, int | float) else other for end, other in ((each.min, -math.inf), (each.max, math.inf)))
            yield _Free(each.name, float(each.value), UNITS[each.unit], (f"parameters.{each.name}.value",), (low, high))


def _dimensions(plan: AssemblyPlan) -> Iterator[_Free]:
    """Yield the dimensions that are lengths in numbers; those of one name and value are one."""
    found: dict[tuple[str, float], list[str]] = {}
    for part in plan.parts:
        given = {name: value for name, value in (getattr(part, "dimensions", None) or {}).items() if isinstance(value, int | float)}
        for name, value in lengths_in(given).items():
            found.setdefault((name, value), []).append(f"parts.{part.name}.dimensions.{name}")
    yield from (_Free(f"{name} of {value:g}", value, "mm", tuple(addresses)) for (name, value), addresses in found.items())


def _drawn(chosen: Sequence[_Free], draw: random.Random) -> dict[str, float]:
    """Return other values, each within its bounds."""
    values = {}
    for each in chosen:
        factor = 1 + draw.choice((-1, 1)) * draw.uniform(*FACTORS)
        low, high = each.bounds
        values[each.name] = min(max(_near(each.value * factor), low), high)
    return values


def _near(value: float) -> float:
    """Return a value as somebody would state it."""
    step = 1.0 if abs(value) >= 20 else 0.5
    return round(value / step) * step


# ---------------------------------------------------------------------- checks

_ADAPTER: Final[TypeAdapter[Any]] = TypeAdapter(AnyCheck)
_LENGTHS: Final = (
    "mm",
    "diameter",
    "pitch",
    "circle",
    "ratio",
    "off",
    "length",
    "by",
    "degrees",
    "level",
    "top",
    "into",
    "opens",
    "opening",
    "at",
)
_ROWS: Final = ("apart", "beside", "piece", "clear")
"""Fields that are a row of lengths, or name what is measured and then the row."""
_SPANS: Final = ("joint", "driver", "follower")


def _unbound(checks: Sequence[AnyCheck]) -> tuple[AnyCheck, ...]:
    return tuple(check for check in checks if not isinstance(check, BOUND))


def _following(checks: Sequence[AnyCheck], subject: Subject, changes: Sequence[_Change]) -> tuple[AnyCheck, ...]:
    """Return the checks with numbers that hold of a subject; those that hold stay as they are.

    Raises:
        NoVariantError: If the numbers of one follow from the changes in no way that is known.
    """
    return tuple(check if check.judge(subject).ok else _renumbered(check, subject, changes) for check in checks)


def _renumbered(check: AnyCheck, subject: Subject, changes: Sequence[_Change]) -> AnyCheck:
    """Return a check with numbers that hold, exactly if there are such, else within its tolerance."""
    tolerance = getattr(check, "tolerance", None)
    for exact in (True, False) if tolerance is not None else (False,):
        for found in _tries(check, changes):
            tried: AnyCheck = found.model_copy(update={"tolerance": EXACT * tolerance}) if exact and tolerance is not None else found
            if tried.judge(subject).ok:
                return found
    raise NoVariantError(f"no numbers of {check.kind} follow: {check.judge(subject).measured}")


def _tries(check: AnyCheck, changes: Sequence[_Change]) -> Iterator[AnyCheck]:
    """Yield a check with other numbers, the fewest of them changed first."""
    slots = list(_slots(check.model_dump(mode="json")))
    ways = [[way for way in _ways(changes) if way(get()) != get()] for get, _ in slots]
    choices = (
        (chosen, steps)
        for count in range(1, len(slots) + 1)
        for chosen in combinations(range(len(slots)), count)
        for steps in product(*(ways[index] for index in chosen))
    )
    for chosen, steps in islice(choices, COSTLY.get(check.kind, COMBINATIONS)):
        row = check.model_dump(mode="json")
        fresh = list(_slots(row))
        for index, step in zip(chosen, steps, strict=True):
            fresh[index][1](step)
        found: AnyCheck = _ADAPTER.validate_python(row)
        yield found


_Way = Callable[[float], float]


def _slots(row: dict[str, Any]) -> Iterator[tuple[Callable[[], float], Callable[[_Way], None]]]:
    """Yield each number of a stored check that a parameter may move: how to read it, and how to move it. The ends of bounds move as one."""
    for name in _LENGTHS:
        value = row.get(name)
        if isinstance(value, int | float):
            yield _slot(row, name)
        elif isinstance(value, list) and len(value) == 2:
            if _narrow(value):
                yield _bounds(row, name)
        elif isinstance(value, list):
            yield from (_slot(value, index) for index, each in enumerate(value) if each is not None)
    for name in _ROWS:
        value = row.get(name)
        if name == "apart" and value and not isinstance(value[1], list):
            yield _bounds(row, name)
            continue
        lengths = value[1] if value and isinstance(value[1], list) else value or []
        yield from (_slot(lengths, index) for index, each in enumerate(lengths) if isinstance(each, int | float))
    for name in _SPANS:
        if isinstance(row.get(name), dict) and isinstance(row[name].get("span"), list) and _narrow(row[name]["span"]):
            yield _bounds(row[name], "span")


def _narrow(bounds: Sequence[float]) -> bool:
    """Return whether bounds lie about one number; wide ones must hold as they are."""
    return float(bounds[1]) - float(bounds[0]) <= NARROW * float(bounds[1])


def _slot(holder: Any, key: Any) -> tuple[Callable[[], float], Callable[[_Way], None]]:
    def move(way: _Way) -> None:
        holder[key] = way(float(holder[key]))

    return lambda: float(holder[key]), move


def _bounds(holder: Any, key: Any) -> tuple[Callable[[], float], Callable[[_Way], None]]:
    def middle() -> float:
        low, high = holder[key]
        return (float(low) + float(high)) / 2

    def move(way: _Way) -> None:
        centre = middle()
        shift = way(centre) - centre
        holder[key] = [_shown(float(end) + shift) for end in holder[key]]

    return middle, move


def _ways(changes: Sequence[_Change]) -> list[_Way]:
    """Return how a number may follow from changes: it is the value, or moves by it, twice, half, or both of two; or is stretched with it."""
    steps = [new - old for old, new in changes]
    shifts = [times * step for step in steps for times in (1, 2, 0.5, -1, -2, -0.5)]
    if len(steps) > 1:
        shifts += [m * steps[0] + n * steps[1] for m in (1, 2, -1, -2) for n in (1, 2, -1, -2)]
    factors = [new / old for old, new in changes]
    factors += [1 / factor for factor in factors]
    if len(factors) > 2:
        factors += [a * b for a in factors[::2] for b in factors[1::2] if abs(a * b - 1) > 1e-9]
    exact = [_replaced(old, new) for old, new in changes]
    return [*exact, *(_shifted(shift) for shift in shifts), *(_stretched(factor) for factor in factors)]


def _replaced(old: float, new: float) -> _Way:
    return lambda value: new if abs(value - old) < 1e-9 else value


def _shifted(step: float) -> _Way:
    return lambda value: _shown(value + step)


def _stretched(factor: float) -> _Way:
    return lambda value: _shown(value * factor)


def _shown(value: float) -> float:
    return float(f"{value:.6g}")


# ---------------------------------------------------------------------- words


def _worded(task: Task, fresh: Task, stages: Sequence[Sequence[_Change]]) -> Task:
    """Return the new task with the texts of the old one, in which the numbers are those that its checks hold."""
    stated = tuple(numbers_of(task))
    replaced: dict[str, list[tuple[tuple[int, int], str]]] = {name: [] for name in texts_of(task)}
    for number in stated:
        known = [change for stage in reversed(stages[: stage_of(number.text) + 1]) for change in stage]
        value = _new_value(task, fresh, number, stated, known)
        if value != number.value:
            replaced[number.text].append((number.place, _written(task, number, value)))
    update: dict[str, Any] = {"prompt": _with(task.prompt, replaced["prompt"])}
    for stage, edit in enumerate(task.edits, start=1):
        fresh = _with_edit(fresh, stage - 1, prompt=_with(edit.prompt, replaced[edit_text(stage)]))
    if task.drawing is not None:
        notes, rest = [], list(replaced["drawing"])
        start = 0
        for note in task.drawing.notes:  # the table reads them as one text
            mine = [((a - start, b - start), text) for (a, b), text in rest if start <= a < start + len(note)]
            notes.append(_with(note, mine))
            start += len(note) + 1
        update["drawing"] = task.drawing.model_copy(update={"notes": tuple(notes)})
    marks = {}
    texts = texts_of(task)
    for mark, reason in task.unheld.items():
        where = next((name for name, text in texts.items() if mark in text), "prompt")
        start = max(texts[where].find(mark), 0)
        mine = [((a - start, b - start), text) for (a, b), text in replaced[where] if start <= a and b <= start + len(mark)]
        marks[_with(mark, mine)] = reason
    return fresh.model_copy(update=update | {"unheld": marks})


def _new_value(task: Task, fresh: Task, number: Number, stated: Sequence[Number], changes: Sequence[_Change]) -> float:
    """Return what becomes of a number of a text: a parameter's new value, itself where it is held still, or what its checks hold now."""
    for old, new in changes:
        if number.unit in {"mm", "deg", "count"} and _figures(task, number) and abs(number.value - old) < 1e-9:
            return new
    pairs = [(_unbound(task.checks), _unbound(fresh.checks))]
    for edit, renewed in list(zip(task.edits, fresh.edits, strict=True))[: stage_of(number.text)]:
        pairs.append((_unbound(edit.checks), _unbound(renewed.checks)))
    holding = [now for was, are in pairs for then, now in zip(was, are, strict=False) if holds(then, number, stated)]
    if not holding or any(holds(check, number, stated) for check in holding):
        return number.value
    for way in _ways(changes):
        moved = _moved(number, way(number.value))
        if any(holds(check, moved, (*stated, moved)) for check in holding):
            return moved.value
    raise NoVariantError(f"no check holds {number.value:g} of: {number.sentence}")


def _moved(number: Number, value: float) -> Number:
    return Number(number.text, number.sentence, number.place, value, number.unit)


def _written(task: Task, number: Number, value: float) -> str:
    """Return how a number is written in place of another."""
    was = _text_of(task, number)
    if not _figures(task, number):
        raise NoVariantError(f"{was!r} is no figure that can be replaced: {number.sentence}")
    return f"{_shown(value * float(was) / number.value):g}"


def _text_of(task: Task, number: Number) -> str:
    return texts_of(task)[number.text][slice(*number.place)]


def _figures(task: Task, number: Number) -> bool:
    """Return whether a number is written in figures."""
    return _text_of(task, number).replace(".", "", 1).isdigit()


def _with(text: str, replaced: Sequence[tuple[tuple[int, int], str]]) -> str:
    for (start, end), new in sorted(replaced, reverse=True):
        text = text[:start] + new + text[end:]
    return text
