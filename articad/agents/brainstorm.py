"""Brainstorm: alternatives for an open request; code checks that they differ in structure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import combinations
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Field

from articad.agents.llm import LLM, Message, Request, assistant, system, user
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, reader, schema_of
from articad.agents.requirements import pictures_of, slug
from articad.errors import OutputError
from articad.findings import Finding, Findings
from articad.runs.run import RunRequest

SCHEMA: Final = "articad.alternatives/1"
ROLE: Final = "brainstorm"
COUNT: Final = 3
TRIES: Final = 3  # answers until the alternatives differ
JointKind = Literal["fixed", "revolute", "slider", "cylindrical", "ball", "screw", "planar", "universal"]


class Tie(ReplyForm):
    """A joint between two parts."""

    type: JointKind
    between: tuple[str, str]


class Alternative(ReplyForm):
    """One product that would satisfy the request.

    Attributes:
        name: Its name.
        summary: What it is and does.
        why: What it has that the others have not.
        parts: Its rigid pieces.
        joints: What moves against what.
    """

    name: Annotated[str, BeforeValidator(slug)]
    summary: str
    why: str
    parts: tuple[str, ...] = Field(min_length=1)
    joints: tuple[Tie, ...]


class Alternatives(ReplyForm):
    """Several of them, the best first."""

    alternatives: tuple[Alternative, ...]


Choose = Callable[[Sequence[Alternative]], int]
"""Given the alternatives, returns the number of the chosen one, from 1."""


def propose(request: RunRequest, llm: LLM, *, count: int = COUNT) -> tuple[tuple[Alternative, ...], Findings]:
    """Ask for alternatives until no two have the same joint graph.

    Returns:
        The alternatives, the best first, and `W_ALTERNATIVES` if fewer than `count` are structurally distinct.

    Raises:
        OutputError: If no answer has the required form.
    """
    opening = (system(prompt("brainstorm", count=str(count))), user(_words(request), *pictures_of(request)))
    read = reader(Alternatives)
    messages: tuple[Message, ...] = opening
    best: tuple[Alternative, ...] = ()
    for number in range(1, TRIES + 1):
        step = "brainstorm" if number == 1 else f"brainstorm/{number}"
        reply = llm.complete(Request(ROLE, step, messages, schema_of(Alternatives)))
        try:
            proposed = read(reply.text, step).alternatives
            complaint = "\n".join(problems(proposed, count))
        except OutputError as error:
            if number == TRIES and not best:
                raise
            proposed, complaint = (), error.message
        sound = distinct(proposed)[:count]
        best = sound if len(sound) > len(best) else best
        if not complaint:
            return best, Findings()
        messages = (*opening, assistant(reply.text), user(prompt("form_repair", problem=complaint)))
    if not best:
        raise OutputError(f"No usable alternative in {TRIES} answers.\n{complaint}", raw=reply.text)
    message = f"Only {len(best)} of {count} alternatives are complete and structurally distinct."
    return best, Findings([Finding(code="W_ALTERNATIVES", where="alternatives", message=message, hint="Choose among these, or ask again.")])


def problems(proposed: Sequence[Alternative], count: int) -> list[str]:
    """Return what is wrong with alternatives: too few of them, joints to unknown parts, loose parts, and duplicates."""
    found = [] if len(proposed) == count else [f"{count} alternatives are wanted, not {len(proposed)}."]
    for number, one in enumerate(proposed, 1):
        found += [f"Alternative {number} ({one.name}): {problem}" for problem in _faults(one)]
    for (i, one), (j, other) in combinations(enumerate(proposed, 1), 2):
        if same_structure(one, other):
            found.append(
                f"Alternatives {i} ({one.name}) and {j} ({other.name}) have the same joint graph: {structure(one)}. "
                f"Replace {j} by one whose parts move against each other in another way."
            )
    return found


def distinct(proposed: Sequence[Alternative]) -> tuple[Alternative, ...]:
    """Return the alternatives that have no fault and differ from all before them."""
    kept: list[Alternative] = []
    for one in proposed:
        if not _faults(one) and not any(same_structure(one, other) for other in kept):
            kept.append(one)
    return tuple(kept)


def structure(one: Alternative) -> str:
    """Return a joint graph in words."""
    kinds = Counter(tie.type for tie in one.joints)
    return f"{len(one.parts)} parts, " + (", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "no joints")


def same_structure(one: Alternative, other: Alternative) -> bool:
    """Return whether two joint graphs are equal up to the names of the parts."""
    if len(one.parts) != len(other.parts) or Counter(t.type for t in one.joints) != Counter(t.type for t in other.joints):
        return False
    edges, others = _edges(one), _edges(other)
    colors, other_colors = _colors(one.parts, edges), _colors(other.parts, others)
    if Counter(colors.values()) != Counter(other_colors.values()):
        return False
    order = sorted(one.parts, key=lambda part: (Counter(colors.values())[colors[part]], part))

    def extended(mapping: dict[str, str]) -> bool:
        if len(mapping) == len(order):
            return True
        part = order[len(mapping)]
        for candidate in other.parts:
            if candidate in mapping.values() or other_colors[candidate] != colors[part]:
                continue
            if all(edges.get(frozenset((part, a))) == others.get(frozenset((candidate, b))) for a, b in mapping.items()) and extended(
                mapping | {part: candidate}
            ):
                return True
        return False

    return extended({})


def to_json(alternatives: Sequence[Alternative], chosen: int, by: str) -> dict[str, Any]:
    """Return `alternatives.json`: what was proposed, which one was chosen (from 1), and by whom."""
    proposed = [one.model_dump(mode="json") for one in alternatives]
    return {"schema": SCHEMA, "alternatives": proposed, "chosen": chosen, "by": by}


_Edges = dict[frozenset[str], tuple[str, ...]]


def _edges(one: Alternative) -> _Edges:
    """Return the types of the joints by the pair of parts that they connect."""
    found: dict[frozenset[str], list[str]] = {}
    for tie in one.joints:
        found.setdefault(frozenset(tie.between), []).append(tie.type)
    return {pair: tuple(sorted(types)) for pair, types in found.items()}


def _colors(parts: Sequence[str], edges: _Edges) -> dict[str, str]:
    """Return a colour for each part, the same in equal graphs: refined by the neighbours' colours once per part (Weisfeiler-Leman)."""
    colors = dict.fromkeys(parts, "")
    for _ in parts:
        around = {
            part: sorted((types, colors[next(iter(pair - {part}), part)]) for pair, types in edges.items() if part in pair)
            for part in parts
        }
        marks = {seen: str(n) for n, seen in enumerate(sorted(set(map(repr, around.values()))))}
        colors = {
            part: f"{marks[repr(around[part])]}:{len(around[part])}:{','.join('+'.join(t) for t, _ in around[part])}" for part in parts
        }
    return colors


def _faults(one: Alternative) -> list[str]:
    found = [f"part {name!r} is listed twice." for name, count in Counter(one.parts).items() if count > 1]
    for tie in one.joints:
        found += [f"a joint names {name!r}, which is not among its parts." for name in tie.between if name not in one.parts]
        if tie.between[0] == tie.between[1]:
            found.append(f"a joint connects {tie.between[0]!r} with itself.")
    reached, waiting = {one.parts[0]}, [one.parts[0]]
    while waiting:
        part = waiting.pop()
        for tie in one.joints:
            for a, b in (tie.between, tie.between[::-1]):
                if a == part and b not in reached:
                    reached.add(b)
                    waiting.append(b)
    loose = [part for part in one.parts if part not in reached]
    return found + ([f"not joined to the rest: {', '.join(loose)}."] if loose else [])


def _words(request: RunRequest) -> str:
    return f"The request:\n\n{request.prompt.strip() or '(no words; see the pictures)'}"
