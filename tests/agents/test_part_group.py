"""The first scripts of several parts come from one request; what fails is asked for alone."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from articad.agents.llm import Request, Scripted, Text
from articad.agents.part_group import LEAST, grouped, sections
from articad.agents.pipeline import generate, resume
from articad.agents.review import scores, trajectory
from articad.agents.settings import RunOptions
from articad.errors import TransportError
from articad.runs.run import Run
from tests.agents import stories
from tests.agents.stories import FLAP_PLAN, FLAP_SCRIPTS, fenced

PEGS = ("ann", "bob", "cat")
DEFAULT = {"together": RunOptions().together, "look": RunOptions().look}


def row() -> dict[str, Any]:
    """A plate with pegs on it, which are fixed to it."""
    plan = copy.deepcopy(FLAP_PLAN)
    plate, flap = plan["parts"]
    plan |= {"name": "row", "freedoms": 0, "parameters": [], "parts": [plate], "joints": []}
    plate |= {"description": "Box x from 0 to length, y from 0 to width, z from 0 to side.", "connectors": []}
    plate["dimensions"]["width"] = 70
    for number, name in enumerate(PEGS):
        peg = copy.deepcopy(flap) | {
            "name": name,
            "rest_pose": {"at": [0, 20 * number, 10]},
            "dimensions": {"length": 30, "side": 10, "thickness": 2},
            "description": "Box x from 0 to length, y from 0 to side, z from 0 to thickness.",
        }
        seat = {"name": f"seat_{name}", "o": [0, 20 * number + 5, 10], "z": [0, -1, 0], "x": [1, 0, 0], "label": "seat"}
        plate["connectors"].append(seat)
        plan["parts"].append(peg)
        plan["joints"].append({"name": f"holds_{name}", "type": "fixed", "parent": f"plate.seat_{name}", "child": f"{name}.axis"})
    return plan


PLATE = """
from build123d import Align, Box

def build(part):
    d = part.dimensions
    shape = Box(d["length"], d["width"], d["side"], align=(Align.MIN,) * 3)
    return shape, {name: {"o": frame.o, "z": frame.z, "x": frame.x} for name, frame in part.connectors.items()}
"""
PEG = FLAP_SCRIPTS["flap"].replace('Pos(0, 0, d["lift"]) * ', "")
ROW = {"plate": PLATE} | dict.fromkeys(PEGS, PEG)


def answer(**scripts: str) -> str:
    return "\n\n".join(f"## {name}\n\n{fenced(text)}" for name, text in scripts.items())


def said(request: Request) -> str:
    return "\n".join(part.text for message in request.messages for part in message.parts if isinstance(part, Text))


def made(folder: Path, llm: Scripted, **options: Any) -> Run:
    given = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **(DEFAULT | {"inspection": False} | options))
    return generate("a row of pegs", llm=llm, out=folder, **given)


def model(**answers: Any) -> Scripted:
    script: dict[str, Any] = {"requirements": stories.requirements("row"), "design/1": json.dumps(row())}
    return Scripted(script | stories.watched() | {step.replace("__", "/"): text for step, text in answers.items()})


@given(st.integers(0, 60), st.integers(1, 12))
def test_groups_keep_the_order_and_differ_by_one_part(count: int, most: int) -> None:
    names = [f"part_{number}" for number in range(count)]
    groups = grouped(names, most)
    if min(count, most) < LEAST:
        assert groups == []
        return
    assert [name for group in groups for name in group] == names
    sizes = {len(group) for group in groups}
    assert max(sizes) <= most
    assert max(sizes) - min(sizes) <= 1


def test_an_answer_is_split_by_headings_and_by_no_line_of_a_script() -> None:
    script = "def build(part):\n# bob\n## cat\n    return 1\n"
    text = f"Here they are.\n\n# `ann`:\n```python\n{script}```\n### cat\n```python\npass\n```\n## nobody\nwords\n"

    found = sections(text, PEGS)

    assert found == {"ann": f"```python\n{script}```\n", "cat": "```python\npass\n```\n## nobody\nwords\n"}


def test_one_request_brings_the_scripts_of_all_parts(tmp_path: Path) -> None:
    llm = model(parts__plate__1=answer(**ROW))
    run = made(tmp_path / "run", llm)

    assert llm.steps == ["requirements", "design/1", "parts/plate/1", "survey/plate/1"]
    told = said(llm.requests[-2])
    assert all(f"## {name}\n" in told for name in ROW)
    assert told.count("# The contract") == 1
    assert (run.checks() or {})["ok"]
    assert trajectory(run)["scripts"] == dict.fromkeys(sorted(ROW), 1)


def test_what_is_missing_or_wrong_is_asked_for_alone_and_looked_at(tmp_path: Path) -> None:
    wrong = PEG.replace('d["thickness"]', 'd["thicknes"]')
    llm = model(
        parts__plate__1=answer(plate=PLATE, ann=ROW["ann"], bob=wrong), part__cat__1=fenced(ROW["cat"]), part__bob__2=fenced(ROW["bob"])
    )
    run = made(tmp_path / "run", llm)

    assert sorted(llm.steps[2:]) == ["look/bob/2", "part/bob/2", "part/cat/1", "parts/plate/1", "survey/plate/1"]
    repair = next(request for request in llm.requests if request.step == "part/bob/2")
    told = said(repair)
    assert "thicknes" in told
    assert "## ann" not in told  # a repair has the part's own entry alone
    assert trajectory(run)["scripts"] == {"ann": 1, "bob": 2, "cat": 1, "plate": 1}
    assert scores(run)["first_shot"] == 0.75


def test_a_part_that_cannot_be_built_as_ordered_goes_to_the_designer(tmp_path: Path) -> None:
    answers = answer(**{name: text for name, text in ROW.items() if name != "cat"})
    refusal = '\n## cat\n\n```json\n{"cannot_be_built": "side and thickness contradict each other"}\n```\n'
    mended = row()
    mended["parts"][3]["dimensions"]["thickness"] = 3
    llm = model(
        parts__plate__1=answers + refusal, design__2=json.dumps(mended), part__cat__2=fenced(ROW["cat"]), part__cat__5=fenced(ROW["cat"])
    )
    made(tmp_path / "run", llm)

    assert "design/2" in llm.steps
    assert [step for step in llm.steps if step.startswith("parts/")] == ["parts/plate/1"]  # one part is changed, and asked for alone


def test_a_run_that_is_resumed_asks_no_group_again(tmp_path: Path) -> None:
    def used_up(request: Request) -> str:
        raise TransportError(f"Nobody answers {request.step}.")

    llm = model(parts__plate__1=answer(**{name: text for name, text in ROW.items() if name != "cat"}), part__cat__1=used_up)
    with pytest.raises(TransportError):
        made(tmp_path / "run", llm)
    later = Scripted({"part/cat/1": fenced(ROW["cat"]), "survey/*": stories.surveyed})
    services = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache())["services"]

    run = resume(tmp_path / "run", llm=later, services=services)

    assert later.steps == ["part/cat/1", "survey/plate/1"]
    assert (run.checks() or {})["ok"]


def test_a_part_that_the_user_drew_is_asked_for_alone(tmp_path: Path) -> None:
    picture = tmp_path / "bob.png"

    Image.new("RGB", (32, 32), "white").save(picture)
    llm = model(parts__plate__1=answer(**{name: text for name, text in ROW.items() if name != "bob"}), part__bob__1=fenced(ROW["bob"]))
    given = stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **(DEFAULT | {"inspection": False}))
    generate("a row", llm=llm, part_images={"bob": picture}, out=tmp_path / "run", **given)

    assert sorted(llm.steps[2:]) == ["look/bob/1", "part/bob/1", "parts/plate/1", "survey/plate/1"]
