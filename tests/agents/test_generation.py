"""What the author of a part reads: all of its own entry, and nothing about other parts."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from articad.agents.llm import LLM, Image, Request
from articad.agents.part_writer import ROLE, Attempt, messages_after, opening
from articad.agents.pipeline import generate
from articad.agents.requirements import Requirements
from articad.agents.retrieval import NoDocumentation, NoMemory, Recalled
from articad.plan.entry import specification
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from tests.agents import stories
from tests.agents.stories import PROMPTS

SEWING_BOX: dict[str, Any] = json.loads((PROMPTS / "sewing_box.json").read_text())


def key(plan: dict[str, Any], part: str) -> str:
    resolved = resolve(AssemblyPlan.from_json(plan))
    return Request(ROLE, f"part/{part}/1", messages_after(opening(resolved, part, "build123d"), None)).key


def part_of(plan: dict[str, Any], name: str) -> dict[str, Any]:
    entry: dict[str, Any] = next(part for part in plan["parts"] if part["name"] == name)
    return entry


def rewritten(plan: dict[str, Any]) -> None:
    body = part_of(plan, "body")
    body |= {"description": "A barrel.", "color": "#112233", "material": "brass", "dimensions": {"radius": 70}, "envelope_mm": None}


def broken(plan: dict[str, Any]) -> None:
    part_of(plan, "body")["dimensions"] = {"nonsense": -1}


def added(plan: dict[str, Any]) -> None:
    plan["parts"].append(
        {
            "name": "cat",
            "material": "brass",
            "description": "a cat",
            "connectors": [{"name": "paw", "o": [0, 0, 0], "z": [0, 0, 1], "label": "p"}],
        }
    )
    part_of(plan, "body")["connectors"].append({"name": "seat", "o": [0, 0, 0], "z": [0, 0, 1], "label": "seat of the cat"})
    plan["joints"].append({"name": "sits", "type": "fixed", "parent": "body.seat", "child": "cat.paw"})


def renamed(plan: dict[str, Any]) -> None:
    text = json.dumps(plan).replace('"body', '"carcass').replace("hinge_left", "left_pin")
    plan.clear()
    plan.update(json.loads(text))


def moved(plan: dict[str, Any]) -> None:
    for name in ("knob", "drawer", "lid_left"):
        part_of(plan, name)["rest_pose"] = {"at": [1, 2, 3]}


@pytest.mark.parametrize("change", [rewritten, broken, added, renamed, moved])
def test_nothing_that_happens_to_other_parts_changes_a_parts_request(change: Callable[[dict[str, Any]], None]) -> None:
    other = copy.deepcopy(SEWING_BOX)
    change(other)

    for part in ("lid_left", "knob", "drawer"):
        assert key(other, part) == key(SEWING_BOX, part)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("description", "A lid."),
        ("dimensions", {"length": 3}),
        ("role", "x"),
        ("orientation", "x"),
        ("material", "brass"),
        ("envelope_mm", [1, 1, 1]),
    ],
)
def test_everything_of_its_own_entry_does(field: str, value: object) -> None:
    other = copy.deepcopy(SEWING_BOX)
    part_of(other, "lid_left")[field] = value

    assert key(other, "lid_left") != key(SEWING_BOX, "lid_left")


def test_the_specification_has_every_dimension_connector_and_word_of_the_entry() -> None:
    resolved = resolve(AssemblyPlan.from_json(SEWING_BOX))
    told = specification(resolved, "drawer")
    entry = part_of(SEWING_BOX, "drawer")

    assert entry["description"] in told
    assert entry["orientation"] in told
    for line in ("- width = 227", "- length = 133.5", "envelope_mm: 227 x 133.5 x 39"):
        assert line in told
    assert "- slide (slide_axis): o = (0, 0, 0), z = (0, -1, 0), x = (1, 0, 0); middle of the front lower edge" in told
    assert "slider joint, the part moves: travel_mm (0, 98)" in told
    assert "body" not in told


def test_last_bits_of_a_number_do_not_show() -> None:
    other = copy.deepcopy(SEWING_BOX)
    part_of(other, "lid_left")["dimensions"]["length"] = "width / 2 - gap / 2 + 1e-12 * cos(45)"

    assert key(other, "lid_left") == key(SEWING_BOX, "lid_left")


def test_an_x_that_the_plan_leaves_free_is_said_to_be_free() -> None:
    other = copy.deepcopy(SEWING_BOX)
    for name, connector in (("knob", "seat"), ("drawer", "knob")):
        frames = part_of(other, name)["connectors"]
        del next(frame for frame in frames if frame["name"] == connector)["x"]

    assert "z = (0, -1, 0); x is free; middle of the seat" in specification(resolve(AssemblyPlan.from_json(other)), "knob")


def test_a_repair_shows_the_last_answer_what_was_wrong_and_the_picture() -> None:
    first = opening(resolve(AssemblyPlan.from_json(SEWING_BOX)), "knob", "build123d")
    picture = Image(b"png", recipe={"part": "knob"})
    messages = messages_after(first, Attempt("my script", "line 3 is wrong", picture))

    assert messages[: len(first)] == first
    assert [message.speaker for message in messages[len(first) :]] == ["assistant", "user"]
    text = json.dumps([message.to_json() for message in messages])
    assert "my script" in text
    assert "line 3 is wrong" in text
    assert picture in messages[-1].parts


class Remembers:
    """A memory of one good and one bad run."""

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:  # noqa: ARG002 - the protocol's
        return Recalled(heuristics=[f"Of {prompt}: hinge it outside."], constraints=["Never bury a hinge."])

    def for_part(self, specification: str, kernel: str) -> list[str]:
        return [f"A lid for {kernel}, like: {specification.splitlines()[0]}"]


class Knows:
    """A documentation with one page."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> list[str]:  # noqa: ARG002 - the protocol's
        return ["Box(length, width, height)"]


def test_what_was_retrieved_enters_the_request_and_nothing_retrieved_leaves_it_as_it_was() -> None:
    resolved = resolve(AssemblyPlan.from_json(SEWING_BOX))
    plain, empty = (opening(resolved, "knob", "build123d"), opening(resolved, "knob", "build123d", examples=(), snippets=()))
    full = opening(resolved, "knob", "build123d", examples=["an example"], snippets=["a snippet"])

    assert Request(ROLE, "part/knob/1", plain).key == Request(ROLE, "part/knob/1", empty).key
    assert "an example" in str(full[0].parts[0])
    assert "a snippet" in str(full[0].parts[0])
    assert full[1] == plain[1]


def test_designers_are_told_of_good_and_bad_runs_and_modellers_of_good_ones(tmp_path: Path) -> None:
    llm = stories.flap()
    folder = tmp_path / "run"
    cache, kernel = stories.shared_cache(), stories.kernel()
    generate(
        "a flap", llm=llm, out=folder, **stories.settings(kernel=kernel, cache=cache, memory=Remembers(), documentation=Knows(), look=False)
    )
    told = {request.step: json.dumps(request.to_json(), ensure_ascii=False) for request in llm.requests}

    assert "Of a flap: hinge it outside." in told["design/1"]
    assert "Never bury a hinge." in told["design/1"]
    assert "A lid for build123d, like: name: plate" in told["part/plate/1"]
    assert "Box(length, width, height)" in told["part/plate/1"]
    assert not [step for step, text in told.items() if "Never bury" in text and step != "design/1"]


def test_an_empty_memory_is_as_none(tmp_path: Path) -> None:
    keys = []
    for memory in (None, NoMemory()):
        llm = stories.flap()
        folder, cache = tmp_path / str(memory is None), stories.shared_cache()
        generate(
            "a flap",
            llm=llm,
            out=folder,
            **stories.settings(kernel=stories.kernel(), cache=cache, memory=memory, documentation=NoDocumentation()),
        )
        keys.append({request.step: request.key for request in llm.requests})

    assert keys[0] == keys[1]
