"""The table of sentences: every number of a task is held by a check or marked, and every check is stated, in tasks made for it and in all of ours."""

from __future__ import annotations

from typing import Any

import pytest

from articad_bench.sentences import numbers_of, sentences
from articad_bench.task import TASKS, Task, tasks_in

OURS = {task.name: task for _, task in tasks_in(TASKS)}
LEVER: dict[str, Any] = {"type": "revolute", "span": [89, 91]}


def task(prompt: str, *checks: dict[str, Any], **more: Any) -> Task:
    return Task.model_validate({"name": "made", "kind": "articulated", "product": "made", "prompt": prompt, "checks": checks} | more)


def told(prompt: str) -> list[tuple[float, str]]:
    return [(round(number.value, 6), number.unit) for number in numbers_of(task(prompt))]


@pytest.mark.parametrize(
    ("prompt", "expected"),
    [
        ("A box 600 x 480 x 300 mm.", [(600, "mm"), (480, "mm"), (300, "mm")]),
        ("It opens by 60 to 80 degrees and slides 12.5 mm.", [(60, "deg"), (80, "deg"), (12.5, "mm")]),
        ("Twenty-five turns of 2 mm; a 45-degree slope.", [(25, "turn"), (2, "mm"), (45, "deg")]),
        ("Five bodies, one loop, one freedom, one of them round.", [(5, "count"), (1, "count"), (1, "count")]),
        ("An M12 nut on an A4 sheet, v2 of it.", []),
        ("Two 8 mm pins.", [(2, "count"), (8, "mm")]),
        ("It takes 0.5 litres, weighs 250 g, and goes round 13/8 times.", [(500, "ml"), (0.25, "kg"), (1.625, "count")]),
        ("A crank 36, pivots 72 apart.", [(36, "count"), (72, "count")]),
    ],
)
def test_numbers_are_read_with_their_units(prompt: str, expected: list[tuple[float, str]]) -> None:
    assert told(prompt) == expected


def test_a_number_is_held_by_a_check_of_its_unit_and_value_alone() -> None:
    def held(prompt: str, *checks: dict[str, Any]) -> list[bool]:
        return [row.held for row in sentences(task(prompt, *checks)).numbers]

    turns = {"kind": "joints", "joint": LEVER, "number": [1, 1]}
    assert held("It turns by 90 degrees.", turns) == [True]
    assert held("It turns by 45 degrees either way.", turns) == [True]
    assert held("It turns by 80 degrees.", turns) == [False]
    assert held("It is 90 mm long.", turns) == [False]
    assert held("It is 90 mm long.", {"kind": "part_size", "mm": [90, None, None]}) == [True]
    assert held("Six legs.", {"kind": "parts", "number": [4, 20]}) == [False]  # that it may be six holds nothing
    assert held("Six legs.", {"kind": "parts", "number": [6, 20]}) == [True]
    assert held("Gears of 24 and 48 teeth.", {"kind": "ratio", "driver": LEVER, "follower": LEVER, "ratio": 2}) == [True, True]
    assert held("Gears of 24 and 40 teeth.", {"kind": "ratio", "driver": LEVER, "follower": LEVER, "ratio": 2}) == [False, False]
    assert held("It has 0.1 mm of play.", {"kind": "gap", "joint": LEVER, "mm": [0.05, 0.2]}) == [True]


def test_a_mark_says_why_no_check_holds_a_number_and_marks_nothing_else() -> None:
    checks = ({"kind": "parts", "number": [6, 20]},)
    marked = sentences(task("Six legs for a dog of 40 kg.", *checks, unheld={"40 kg": "Whom it is for."}))
    stale = sentences(task("Six legs for a dog of 40 kg.", *checks, unheld={"40 kg": "Whom it is for.", "Six legs": "Held."}))

    assert [(row.held, row.reason) for row in marked.numbers] == [(True, None), (True, "Whom it is for.")]
    assert marked.stale == ()
    assert stale.stale == ("Six legs",)


def test_a_check_whose_number_no_text_states_is_found() -> None:
    def stated(prompt: str, check: dict[str, Any], **more: Any) -> str | None:
        (row,) = sentences(task(prompt, check, **more)).checks
        return row.stated

    size = {"kind": "size", "mm": [90, None, None]}
    assert stated("A box 90 mm long. It is red.", size) == "prompt: A box 90 mm long."
    assert stated("A box.", size) is None
    assert stated("", size, drawing={}) == "drawing: measures of the whole"
    assert stated("", {"kind": "part_size", "mm": [90, None, None]}, drawing={}) is None
    assert stated("", {"kind": "part_size", "mm": [90, None, None]}, drawing={"parts": ["lid"]}) == "drawing: sides of lid"
    assert (
        stated("A tube 24 mm outside with a wall of 2 mm.", {"kind": "holes", "diameter": 20, "number": [1, 1]}) == "follows: 24 - 2 x 2 mm"
    )
    window = {"kind": "section", "axis": "x", "at": 10, "openings": [1, 1], "clear": [[300, 400], [100, 150]]}
    assert stated("", window, drawing={}) == "drawing: its views, within 10 %"
    assert stated("", window | {"clear": [[340, 360], [100, 150]]}, drawing={}) is None
    assert stated("A box.", window) is None
    assert stated("A box.", {"kind": "stands", "degrees": 20}) is None
    assert stated("A box.", {"kind": "stands"}) == "all tasks: it stands freely"
    round_and_round = {"kind": "travel", "joint": {"type": "revolute", "span": "endless"}, "by": [355, 365]}
    assert stated("It goes round without end.", round_and_round) == "words: what goes round without end"
    assert stated("It goes round without end.", round_and_round | {"by": [170, 190]}) is None


def test_the_numbers_of_an_edit_are_held_by_the_checks_of_the_edited_product() -> None:
    edit = {"prompt": "Make it 80 mm long.", "checks": [{"kind": "part_size", "mm": [80, None, None]}]}
    table = sentences(task("A bar 90 mm long.", {"kind": "part_size", "mm": [90, None, None]}, edits=[edit]))

    assert [row.held for row in table.numbers] == [True, True]
    assert [row.stated for row in table.checks] == ["prompt: A bar 90 mm long.", "edit 1: Make it 80 mm long."]
    other = edit | {"checks": [{"kind": "part_size", "mm": [85, None, None]}]}
    assert [row.held for row in sentences(task("A bar.", edits=[other])).numbers] == [False]


@pytest.mark.parametrize("name", OURS)
def test_every_number_of_our_tasks_has_a_check_and_every_check_a_sentence(name: str) -> None:
    table = sentences(OURS[name])

    assert [(row.number.value, row.number.unit, row.number.sentence) for row in table.numbers if not row.held] == []
    assert [(row.kind, row.check) for row in table.checks if row.stated is None] == []
    assert table.stale == ()
