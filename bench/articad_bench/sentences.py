"""The table of a task's sentences: which check holds each number that it states, and where the numbers of each check are stated.

A number is one in figures, in words from two to ninety-nine, or "one" before a freedom or a loop. It is held by a check that has the same number
in the same unit: as the end of its bounds, or closely between them. What no check can hold is marked in the task, under `unheld`, with the
reason. The other way round, the numbers of a check stand in the text, or in the drawing, which states the measures of the whole, what the
joints do and how far, and the sides of the parts that it names. What needs no number follows from words, or from what all tasks have in common.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal

from articad.kinematics.joints import JointType
from articad_bench.checks import AnyCheck, JointWanted
from articad_bench.task import Task

__all__ = ["CheckRow", "Number", "NumberRow", "Sentences", "edit_text", "holds", "numbers_of", "sentences", "stage_of", "texts_of"]

Unit = Literal["mm", "deg", "kg", "ml", "%", "turn", "N", "N m", "N/mm²", "count"]
Value = tuple[Unit, float, float]
"""A number of a check: its unit and bounds."""

CLOSE: Final = 0.13  # of a number, by which the bounds of a check may lie about it on either side
EXACT: Final = 0.0051  # of a number: ratios are told in three figures
TURN: Final = 360.0
STANDS: Final = 5.0  # degrees of lean at which all that stands must stand
_UNITS: Final[dict[str, tuple[Unit, float]]] = {
    "mm": ("mm", 1.0),
    "millimetre": ("mm", 1.0),
    "millimetres": ("mm", 1.0),
    "degree": ("deg", 1.0),
    "degrees": ("deg", 1.0),
    "°": ("deg", 1.0),
    "kg": ("kg", 1.0),
    "kilograms": ("kg", 1.0),
    "g": ("kg", 0.001),
    "ml": ("ml", 1.0),
    "litres": ("ml", 1000.0),
    "per cent": ("%", 1.0),
    "turn": ("turn", 1.0),
    "turns": ("turn", 1.0),
    "N": ("N", 1.0),
    "N m": ("N m", 1.0),
    "N/mm²": ("N/mm²", 1.0),
}
_ONES: Final = ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
_TEENS: Final = ("ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen")
_TENS: Final = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_WORDS: Final = (
    {word: float(value) for value, word in enumerate((*_ONES, *_TEENS), start=1)}
    | {ten: 10.0 * row for row, ten in enumerate(_TENS, start=2)}
    | {f"{ten}-{one}": 10.0 * row + value for row, ten in enumerate(_TENS, start=2) for value, one in enumerate(_ONES, start=1)}
)
_NUMBER: Final = re.compile(
    r"(?<![\w./])(?P<figures>\d+(?:\.\d+)?(?:/\d+)?)(?!\w)|\b(?P<word>" + "|".join(sorted(_WORDS, key=len, reverse=True)) + r")\b",
    re.IGNORECASE,
)
_UNIT: Final = re.compile(r"[\s-]*(?P<unit>" + "|".join(sorted(map(re.escape, _UNITS), key=len, reverse=True)) + r")(?![a-z³])")
_BETWEEN: Final = re.compile(r"\s*(,|x|to|by|and|or|and then|and at)?\s*")  # two numbers of one unit
_ONE_OF: Final = re.compile(r"\s+(closed\s+)?(freedom|loop)")
_SENTENCE: Final = re.compile(r"(?<=[.;:!?])\s+")
_TURNING: Final = frozenset({JointType.REVOLUTE, JointType.SCREW, JointType.BALL, JointType.UNIVERSAL})

_SUMS: Final = (("+", "", 1), ("+", "2 x ", 2), ("-", "", -1), ("-", "2 x ", -2))
_LOOSE: Final = {"gap": "mm", "wall": "mm", "fitted": "play"}

FOLLOWS: Final = {
    "solids": "all tasks: every part is one closed solid",
    "clear_at_rest": "all tasks: no two parts share volume",
    "joined": "all tasks: no part floats",
    "clear_in_motion": "all tasks: nothing collides while it moves",
    "certified": "all tasks: nothing collides while it moves",
    "simulates": "all tasks: a simulator holds it and moves it",
    "floor": "all tasks: what stands does not move through the floor",
    "made": "all tasks: surfaces make the joints",
    "moves": "all tasks: a joint moves the body that is described, in wide bounds",
    "matter": "all tasks: matter fills the product, in wide bounds",
    "threads": "all tasks: threads are right-handed unless the task says otherwise",
    "symmetric": "words: the shape that is described",
    "volume": "follows from the measures",
    "mass": "follows from the measures and the material",
    "weighs": "follows from the measures and the material",
    "captive": "words: what cannot come off",
    "arranged": "picture: where the parts lie",
    "outlined": "picture: the outlines",
    "handed": "picture, or words of a side",
    "upright": "picture, or words of what is above, below, in front or behind",
    "unchanged": "edit: what is not to change",
}
"""Where a check comes from that needs no number in the text."""
_DRAWN: Final = {
    "size": "drawing: measures of the whole",
    "extent": "drawing: measures of the whole",
    "parts": "drawing: number of parts",
    "joints": "drawing: what the joints do, and how far",
    "freedoms": "drawing: what drives and what follows",
    "loops": "drawing: what drives and what follows",
    "ratio": "drawing: couplings",
    "turns": "drawing: couplings",
    "lead": "drawing: what the joints do, and how far",
    "travel": "drawing: what the joints do, and how far",
    "rise": "drawing: what the joints do, and how far",
    "reaches": "drawing: what the joints do, how far, and its words where to",
}
"""What every drawing states."""
_ON_SHEETS: Final = _DRAWN | {
    "machined": "sheets: views, dimensions and tables of each part",
    "toleranced": "sheets: fits in the tables of holes",
    "part_size": "sheets: sides of the parts",
    "holes": "sheets: tables of holes",
    "studs": "sheets: dimensions of the parts",
    "gap": "sheets: dimensions of the parts",
    "wall": "sheets: dimensions of the parts",
    "links": "sheets: dimensions of the parts",
    "square": "sheets: tables of holes",
}
"""What dimensioned sheets state."""
_ON_PHOTOS: Final = {
    "parts": "photos: number of parts",
    "joints": "photos: what the joints do",
    "freedoms": "photos: what moves",
    "loops": "photos: what moves",
    "holds": "photos: what is hollow",
}
"""What photos show without a scale."""
PHOTO: Final = 0.1  # of a measure, that somebody who reads photos with care may be off
_VIEWED: Final = frozenset({"section", "holds", "wall"})
"""What the views of a drawing show as well as photos do."""


@dataclass(frozen=True)
class Number:
    """A number that a text states.

    Attributes:
        text: Which text: "prompt", "drawing" (its notes), or "edit 1" and so on.
        sentence: The sentence that it stands in.
        place: Where in the text it begins and ends.
        value: In its unit.
        unit: "count" where none is written: then it may be of any unit.
    """

    text: str
    sentence: str
    place: tuple[int, int]
    value: float
    unit: Unit


@dataclass(frozen=True)
class NumberRow:
    """What holds a number: checks, in words, or the reason why none does."""

    number: Number
    checks: tuple[str, ...]
    reason: str | None

    @property
    def held(self) -> bool:
        """Whether a check holds it, or a reason says why none does."""
        return bool(self.checks) or self.reason is not None


@dataclass(frozen=True)
class CheckRow:
    """Where the numbers of a check are stated; None if nowhere."""

    check: str
    kind: str
    stated: str | None


@dataclass(frozen=True)
class Sentences:
    """The table of a task.

    Attributes:
        numbers: Each number of its texts.
        checks: Each check, those of the edit last.
        stale: Marks of the task under which there is no number that a check does not hold.
    """

    numbers: tuple[NumberRow, ...]
    checks: tuple[CheckRow, ...]
    stale: tuple[str, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the table as data of a report."""
        return asdict(self)


def sentences(task: Task) -> Sentences:
    """Return the table of a task.

    Args:
        task: The task.
    """
    texts, stated = texts_of(task), tuple(numbers_of(task))
    rows, used = [], set()
    for number in stated:
        checks = task.stages[stage_of(number.text)]
        holding = tuple(check.wanted for check in checks if holds(check, number, stated))
        marks = [] if holding else [mark for mark in task.unheld if _covers(mark, texts[number.text], number.place)]
        used.update(marks)
        rows.append(NumberRow(number, holding, task.unheld[marks[0]] if marks else None))
    rows = [row if row.held else NumberRow(row.number, (), _followed(row.number, [each for each in rows if each.checks])) for row in rows]
    told = []
    for stage, checks in enumerate((task.checks, *(edit.checks for edit in task.edits))):
        known = [number for number in stated if stage_of(number.text) <= stage]
        told += [CheckRow(check.wanted, check.kind, _stated(task, check, known)) for check in checks]
    return Sentences(tuple(rows), tuple(told), tuple(mark for mark in task.unheld if mark not in used))


def _followed(number: Number, held: Sequence[NumberRow]) -> str | None:
    """Return how a measure follows from two others of its sentence that checks hold; None if it does not."""
    beside = [row.number for row in held if row.number.text == number.text and row.number.sentence == number.sentence]
    return next(
        (f"It follows: {words} mm." for words, value in _ways(beside) if number.unit == "mm" and abs(value - number.value) < EXACT), None
    )


def edit_text(stage: int) -> str:
    """Return the name of the text that asks for the edit before a stage."""
    return f"edit {stage}"


def stage_of(text: str) -> int:
    """Return the stage that a text is about: 0 for the prompt and the drawing, 1 for the first edit."""
    return int(text.removeprefix("edit ")) if text.startswith("edit ") else 0


def texts_of(task: Task) -> dict[str, str]:
    """Return the texts of a task that state numbers."""
    notes = "" if task.drawing is None else " ".join(task.drawing.notes)
    edits = {edit_text(stage): edit.prompt for stage, edit in enumerate(task.edits, start=1)}
    return {"prompt": task.prompt, "drawing": notes, **edits}


def numbers_of(task: Task) -> Iterator[Number]:
    """Yield the numbers that a task's texts state, in their order."""
    for name, text in texts_of(task).items():
        found = list(_NUMBER.finditer(text))
        for index, match in enumerate(found):
            if (match["word"] or "").lower() == "one" and not _ONE_OF.match(text, match.end()):
                continue
            unit, factor = _unit(text, found[index:])
            yield Number(name, _sentence(text, match.start()), match.span(), factor * _value(match), unit)


def _value(match: re.Match[str]) -> float:
    if match["word"]:
        return _WORDS[match["word"].lower()]
    above, _, below = match["figures"].partition("/")
    return float(above) / float(below or 1)


def _unit(text: str, found: Sequence[re.Match[str]]) -> tuple[Unit, float]:
    """Return the unit of the first of these numbers, and what it is in ours: its own, or that of the next one in a list of figures."""
    written = _UNIT.match(text, found[0].end())
    if written is not None:
        return _UNITS[written["unit"]]
    if len(found) > 1 and found[0]["figures"] and found[1]["figures"] and _BETWEEN.fullmatch(text, found[0].end(), found[1].start()):
        return _unit(text, found[1:])
    return "count", 1.0


def _sentence(text: str, at: int) -> str:
    start = max((match.end() for match in _SENTENCE.finditer(text) if match.end() <= at), default=0)
    end = min((match.start() for match in _SENTENCE.finditer(text) if match.start() > at), default=len(text))
    return text[start:end]


def _covers(mark: str, text: str, place: tuple[int, int]) -> bool:
    return any(match.start() <= place[0] and place[1] <= match.end() for match in re.finditer(re.escape(mark), text))


# ---------------------------------------------------------------------- what checks hold


def holds(check: AnyCheck, number: Number, others: Sequence[Number]) -> bool:
    """Return whether a check holds a number of a task.

    Args:
        check: The check.
        number: The number.
        others: All numbers of the task: a ratio is of two of them.
    """
    if any(_within(number, value) for value in _values(check)):
        return True
    if check.kind in _LOOSE and number.unit == "mm":  # play and walls are told as one number, and held to a range about it
        loose: tuple[float, float] = getattr(check, _LOOSE[check.kind])
        return loose[0] <= number.value <= loose[1]
    ratio = getattr(check, "ratio", None)  # of two diameters, or of two numbers of teeth or turns
    return ratio is not None and any(
        each.text == number.text
        and each.unit == number.unit
        and _near(max(each.value, number.value) / min(each.value, number.value), ratio)
        for each in others
        if each.value != number.value and each.value * number.value > 0
    )


def _near(found: float, ratio: float) -> bool:
    return any(abs(found - wanted) <= EXACT * wanted for wanted in (abs(ratio), 1 / abs(ratio)))


def _within(number: Number, value: Value) -> bool:
    unit, low, high = value
    if number.unit == "turn":
        return unit in {"deg", "count"} and _between(number.value * (360.0 if unit == "deg" else 1.0), low, high, unit)
    if number.unit not in {unit, "count"}:
        return False
    if number.unit == "count" and unit not in {"count", "mm", "deg"}:
        return False
    turned = (1.0, 2.0) if unit in {"deg", "mm"} else (1.0,)  # so much to either side
    return any(_between(times * number.value, low, high, unit) for times in turned)


def _between(number: float, low: float, high: float, unit: Unit) -> bool:
    if any(abs(number - end) <= 1e-6 * max(abs(number), 1.0) for end in (low, high)):
        return True
    return unit != "count" and low <= number <= high and max(high - number, number - low) <= CLOSE * number


def _values(check: AnyCheck) -> Iterator[Value]:
    """Yield the numbers of a check that a text can state."""
    row: Any = check
    for name in ("joint", "driver", "follower"):
        if isinstance(getattr(row, name, None), JointWanted):
            yield from _joint_values(getattr(row, name))
    if hasattr(row, "tolerance"):
        yield "%", 100 * row.tolerance, 100 * row.tolerance
    number = getattr(row, "number", None)
    if number is not None and check.kind != "moves":
        yield ("count", *(number if isinstance(number, tuple) else (number, number)))
    if check.kind in _MEASURES:
        yield from _MEASURES[check.kind](row)


def _joint_values(wanted: JointWanted) -> Iterator[Value]:
    if isinstance(wanted.span, tuple):
        yield ("deg" if wanted.type in _TURNING else "mm", *wanted.span)
    if isinstance(wanted.turn, tuple):
        yield ("deg", *wanted.turn)
    if wanted.axis is not None:  # a slanted axis leans by so much
        lean = math.degrees(math.acos(min(1.0, abs(wanted.axis[2]) / math.hypot(*wanted.axis))))
        yield from (("deg", round(angle, 2), round(angle, 2)) for angle in (lean, 90 - lean) if 0.1 < angle < 89.9)


def _lengths(row: Any, sides: Iterable[float | None]) -> list[Value]:
    """Return lengths of a check with its tolerance; None is any length."""
    return [("mm", (1 - row.tolerance) * side, (1 + row.tolerance) * side) for side in sides if side is not None]


def _counts(*numbers: int) -> list[Value]:
    return [("count", number, number) for number in numbers]


def _bounds(row: Any) -> list[Value]:
    return [("mm", *row.mm)]


def _round_values(row: Any) -> list[Value]:
    lengths = [] if row.length is None else [("mm", *row.length)]
    levels, beside = row.apart[1] if row.apart else (), row.beside[1] if row.beside else ()
    return [*_lengths(row, (row.diameter, row.pitch, row.circle, *levels, *beside)), *lengths, *_heights(row)]


def _heights(row: Any) -> list[Value]:
    return [] if row.above is None else [("mm", *row.above)]


def _section_values(row: Any) -> list[Value]:
    """Return how many pieces and openings a section has, their sides, and how far apart the pieces are."""
    counts: list[Value] = [("count", *each) for each in (row.pieces, row.openings) if each is not None]
    apart: list[Value] = [] if row.apart is None else [("mm", *row.apart)]
    sides: list[Value] = [("mm", *row.bounds(side)) for side in (*(row.piece or ()), *(row.clear or ())) if side is not None]
    return [*counts, *sides, *apart]


def _ratio_values(row: Any) -> list[Value]:
    """Return a ratio and its inverse: as a number, in mm per radian or mm, in mm per turn, and in mm per degree."""
    ratios = [value for ratio in (abs(row.ratio), 1 / abs(row.ratio)) for value in (ratio, 360 * ratio, math.degrees(ratio))]
    units: tuple[Unit, ...] = ("count", "mm")
    return [(unit, (1 - EXACT) * value, (1 + EXACT) * value) for value in ratios for unit in units]


def _exact(lengths: Iterable[float | None]) -> list[Value]:
    return [("mm", length, length) for length in lengths if length is not None]


def _carried_values(row: Any) -> list[Value]:
    """Return the load, the height, the sides and the sag of a board, and what its material bears."""
    material: list[Value] = [("N/mm²", row.stress, row.stress), ("N/mm²", row.modulus, row.modulus)]
    sides = _exact(side for side in (*row.top, row.sag) if side)
    return [("kg", row.kg, row.kg), ("mm", *row.level), *sides, *material]


def _stack_values(row: Any) -> list[Value]:
    """Return what may be left of a stack, the lengths of its pieces and how far they may be off, and the ranges of its joints."""
    found = [*_bounds(row), *(("mm", *piece.mm) for piece in row.pieces)]
    offs = [*(piece.off for piece in row.pieces), *([row.between] if isinstance(row.between, tuple) else [])]
    found += _exact(abs(end) for off in offs for end in off if end)
    return [*found, *(value for play in row.plays for value in _joint_values(play.joint))]


_MEASURES: Final[dict[str, Callable[[Any], list[Value]]]] = {
    "size": lambda row: _lengths(row, row.mm),
    "part_size": lambda row: [*_lengths(row, row.mm), *_heights(row)],
    **dict.fromkeys(("links", "lead", "square"), lambda row: _lengths(row, [row.mm])),
    **dict.fromkeys(("rise", "level", "gap", "extent", "wall", "reaches", "shifted"), _bounds),
    "spaced": lambda row: [
        *_lengths(row, (*row.mm, *row.pitch)),
        *_counts(row.levels, *row.each, row.levels * row.each[0] if len(row.each) == 1 else sum(row.each)),
    ],
    "ordered": lambda row: _lengths(row, [side for sides in row.sizes for side in sides]),
    "turned": lambda row: [*_lengths(row, row.mm), *_counts(*row.alike, sum(row.alike))],
    "fitted": lambda row: [*_lengths(row, (row.diameter,)), ("mm", *row.play)],
    "straight": lambda row: [("mm", *row.mm), ("mm", row.off, row.off)],
    "travel": lambda row: [("deg" if row.joint.type in _TURNING else "mm", *row.by)],
    **dict.fromkeys(("holes", "studs"), _round_values),
    "passage": lambda row: _lengths(row, (row.diameter,)),
    "section": _section_values,
    **dict.fromkeys(("ratio", "turns"), _ratio_values),
    "meshes": lambda row: _counts(*row.teeth),
    "mass": lambda row: [("kg", *row.kg)],
    "holds": lambda row: [("ml", *row.ml)],
    "weighs": lambda row: [("kg", *row.kg), *_lengths(row, row.mm or ())],
    "room": lambda row: _exact(row.mm),
    "stands": lambda row: [("deg", row.degrees, row.degrees)],
    "effort": lambda row: [(row.unit, *row.most), *([("kg", row.load, row.load)] if row.load else [])],
    "carries": _carried_values,
    "folds": lambda row: _exact((*row.into, *row.opens)),
    "passes": lambda row: _exact(row.opening),
    "stack": _stack_values,
}


def _stated(task: Task, check: AnyCheck, stated: Sequence[Number]) -> str | None:
    """Return where a check comes from."""
    told = [number for number in stated if holds(check, number, stated)]
    if told and check.kind not in FOLLOWS:
        return f"{told[0].text}: {told[0].sentence}"
    found = _drawn(task, check) or FOLLOWS.get(check.kind) or _worded(check, stated)
    return found or (None if task.given is None else "given: what nobody asks to change")


def _drawn(task: Task, check: AnyCheck) -> str | None:
    """Return what of the drawing states a check; None if nothing."""
    if task.drawing is None:
        return None
    if task.drawing.form == "sheets":
        return _ON_SHEETS.get(check.kind)
    if task.drawing.form == "photos":
        shown = _ON_PHOTOS.get(check.kind) if check.kind != "joints" or _is_readable(check) else None
        return shown or (f"photos: proportions, within {100 * PHOTO:g} %" if _is_readable(check) else None)
    if check.kind in _DRAWN and (task.drawing.legend or check.kind in {"size", "extent", "parts"}):
        return _DRAWN[check.kind]
    named = check.kind in {"part_size", "studs"} and task.drawing.parts
    if named:
        return f"drawing: sides of {', '.join(task.drawing.parts)}"
    return f"drawing: its views, within {100 * PHOTO:g} %" if check.kind in _VIEWED and _is_readable(check) else None


def _is_readable(check: AnyCheck) -> bool:
    """Return whether all measures of a check have the room that a reader of photos needs."""
    tolerance = getattr(check, "tolerance", None)
    if check.kind in {"size", "part_size", "holes", "studs", "links"} and tolerance is not None:
        return bool(tolerance >= PHOTO) and getattr(check, "length", None) is None
    measured = _MEASURES[check.kind](check) if check.kind in _VIEWED else _values(check)
    return check.kind in {"joints", "extent", "travel", *_VIEWED} and all(
        high - low >= 2 * PHOTO * low for _, low, high in measured if high > low
    )


def _worded(check: AnyCheck, stated: Sequence[Number]) -> str | None:
    """Return what states a check without its numbers; None if they would have to be stated."""
    row: Any = check
    if check.kind == "stands" and row.degrees == STANDS:
        return "all tasks: it stands freely"
    if check.kind in {"ratio", "turns"} and abs(row.ratio) == 1:
        return "words: what turns alike"
    if check.kind == "travel" and row.joint.span == "endless" and row.by[0] <= TURN <= row.by[1]:
        return "words: what goes round without end"
    if check.kind == "gap" and row.mm[0] <= 0 <= row.mm[1]:
        return "words: what touches"
    measured = [value for value in _values(check) if value[0] not in {"count", "%"}]
    return _derived(measured, stated) if measured else "words: what is described"


def _derived(measured: Sequence[Value], stated: Sequence[Number]) -> str | None:
    """Return how each measure of a check follows from two numbers that are stated; None if one does not."""
    found = []
    for unit, low, high in measured:
        told = next((words for words, value in _ways(stated) if unit == "mm" and _between(value, low, high, unit)), None)
        if told is None:
            return None
        found.append(told)
    return f"follows: {', '.join(found)} mm"


def _ways(stated: Sequence[Number]) -> Iterator[tuple[str, float]]:
    """Yield what follows from two measures [mm], in words and as a number.

    A bore and two walls make an outside, half the difference of two diameters is a wall, and turns times a lead are a travel.
    """
    mm = [number.value for number in stated if number.unit == "mm"]
    for a in mm:
        for b in mm:
            if a > b:
                yield from ((f"{a:g} {sign} {words}{b:g}", a + times * b) for sign, words, times in _SUMS)
                yield f"({a:g} - {b:g}) / 2", (a - b) / 2
        yield from ((f"{number.value:g} x {a:g}", number.value * a) for number in stated if number.unit == "turn")
