"""Open requests: alternatives that differ in structure, one of them chosen, and asked for once only."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.agents.brainstorm import Alternative, problems, propose, same_structure
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate, replay
from articad.agents.settings import Services
from articad.errors import AgentError, OutputError
from articad.runs.run import Run, RunRequest
from tests.agents import stories
from tests.agents.stories import flap

Edges = list[tuple[str, str, str]]


def idea(name: str, parts: str, edges: Edges) -> dict[str, Any]:
    joints = [{"type": kind, "between": [a, b]} for kind, a, b in edges]
    return {"name": name, "summary": f"A {name}.", "why": "It differs.", "parts": parts.split(), "joints": joints}


CHAIN = idea("chain", "a b c", [("revolute", "a", "b"), ("revolute", "b", "c")])
CHAIN_AGAIN = idea("same chain", "x y z", [("revolute", "z", "x"), ("revolute", "y", "x")])
MIXED = idea("mixed", "a b c", [("revolute", "a", "b"), ("slider", "b", "c")])
RING = idea("ring", "a b c", [("revolute", "a", "b"), ("revolute", "b", "c"), ("revolute", "c", "a")])
STAR = idea("star", "a b c d", [("ball", "a", "b"), ("ball", "a", "c"), ("ball", "a", "d")])
PATH = idea("path", "a b c d", [("ball", "a", "b"), ("ball", "b", "c"), ("ball", "c", "d")])
HEXAGON = idea("hexagon", "a b c d e f", [("fixed", p, q) for p, q in zip("abcdef", "bcdefa", strict=True)])
TRIANGLES = idea("triangles", "a b c d e f", [("fixed", p, q) for p, q in ("ab", "bc", "ca", "de", "ef", "fd")])


def said(*ideas: dict[str, Any]) -> str:
    return json.dumps({"alternatives": ideas})


def read(one: dict[str, Any]) -> Alternative:
    return Alternative.model_validate(one)


def test_only_names_do_not_make_a_difference() -> None:
    assert same_structure(read(CHAIN), read(CHAIN_AGAIN))


@pytest.mark.parametrize(
    ("one", "other"), [(CHAIN, MIXED), (CHAIN, RING), (STAR, PATH), (HEXAGON, TRIANGLES)], ids=lambda idea: idea["name"]
)
def test_joint_types_loops_and_branches_do(one: dict[str, Any], other: dict[str, Any]) -> None:
    assert not same_structure(read(one), read(other))
    assert not same_structure(read(other), read(one))


def test_what_is_wrong_with_alternatives_is_said_all_at_once() -> None:
    loose = idea("loose", "a b c", [("revolute", "a", "b"), ("slider", "a", "nobody")])
    told = "\n".join(problems([read(CHAIN), read(CHAIN_AGAIN), read(loose)], 4))

    assert "4 alternatives are wanted, not 3" in told
    assert "Alternatives 1 (chain) and 2 (same_chain) have the same joint graph: 3 parts, 2 revolute" in told
    assert "names 'nobody'" in told
    assert "not joined to the rest: c" in told


def test_equal_alternatives_are_asked_for_again_until_three_differ() -> None:
    llm = Scripted({"brainstorm": said(CHAIN, CHAIN_AGAIN, MIXED), "brainstorm/2": said(CHAIN, RING, MIXED)})
    alternatives, findings = propose(RunRequest(prompt="a toy"), llm)

    assert [one.name for one in alternatives] == ["chain", "ring", "mixed"]
    assert len(findings) == 0
    assert llm.steps == ["brainstorm", "brainstorm/2"]
    complaint = json.dumps(llm.requests[1].to_json())
    assert "have the same joint graph" in complaint
    assert "same_chain" in complaint


def test_a_model_without_a_third_idea_leaves_two_and_says_so() -> None:
    alternatives, findings = propose(RunRequest(prompt="a toy"), Scripted({"brainstorm*": said(CHAIN, CHAIN_AGAIN, MIXED)}))

    assert [one.name for one in alternatives] == ["chain", "mixed"]
    assert findings.codes == ("W_ALTERNATIVES",)


def test_a_model_without_any_form_is_given_up() -> None:
    with pytest.raises(OutputError):
        propose(RunRequest(prompt="a toy"), Scripted({"brainstorm*": "ideas? none"}))


# ---------------------------------------------------------------------- in a run


def open_flap(**answers: Any) -> Scripted:
    analysis = json.loads(stories.requirements()) | {"open_ended": True}
    return flap(requirements=json.dumps(analysis), brainstorm=said(CHAIN, RING, MIXED), concept=stories.requirements(), **answers)


def made(tmp_path: Path, llm: Any, name: str = "run", **options: Any) -> Run:
    return generate(
        "a toy", llm=llm, out=tmp_path / name, **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **options)
    )


def chosen(run: Run) -> tuple[int, str]:
    stored = run.alternatives() or {}
    return stored["chosen"], stored["by"]


def test_an_open_request_is_brainstormed_and_the_first_idea_is_made_when_nobody_chooses(tmp_path: Path) -> None:
    llm = open_flap()
    run = made(tmp_path, llm)

    assert llm.steps[:4] == ["requirements", "brainstorm", "concept", "design/1"]
    assert chosen(run) == (1, "articad")
    assert '"name": "chain"' in str(llm.requests[2].messages[-1].parts[0])


def test_a_number_picks_and_spares_the_first_analysis(tmp_path: Path) -> None:
    llm = open_flap()
    run = made(tmp_path, llm, pick=2)

    assert llm.steps[:3] == ["brainstorm", "concept", "design/1"]
    assert chosen(run) == (2, "user")
    assert '"name": "ring"' in str(llm.requests[1].messages[-1].parts[0])


def test_a_callback_is_shown_the_alternatives_and_is_not_asked_again_on_resuming_or_replaying(tmp_path: Path) -> None:
    shown: list[list[str]] = []

    def choose(alternatives: Any) -> int:
        shown.append([one.name for one in alternatives])
        return 3

    run = made(tmp_path, open_flap(), choose=choose)
    made(tmp_path, Scripted({}), choose=choose)
    again = replay(run.path, out=tmp_path / "again", strict=True, services=Services(kernel=stories.kernel(), cache=stories.shared_cache()))

    assert shown == [["chain", "ring", "mixed"]]
    assert chosen(run) == chosen(again.run) == (3, "user")
    assert again.differences == ()


def test_a_request_that_names_its_product_is_not_brainstormed_unless_asked(tmp_path: Path) -> None:
    named, asked = flap(), open_flap()
    made(tmp_path, named)
    made(tmp_path, asked, "asked", ideas="never")

    assert "brainstorm" not in [*named.steps, *asked.steps]


def test_an_alternative_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(AgentError, match="no alternative 4; there are 1 chain, 2 ring, 3 mixed"):
        made(tmp_path, open_flap(), pick=4)
