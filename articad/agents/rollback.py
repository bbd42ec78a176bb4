"""Rollback: whose fault a failure is, and what is to be made again.

Geometry decides first: a finding with a root cause knows who must act, and a breach of a contract is its script's. A model is
asked only about what geometry leaves open. A finding that comes back is not sent the same way again: what a script did not mend
goes to the designer, what a designer did not mend goes back with the demand for another solution, and the third time ends it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from articad.agents.llm import LLM, system, user
from articad.agents.part_writer import specification
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of, unusable
from articad.findings import Finding, Findings
from articad.plan.resolve import ResolvedPlan

SCHEMA: Final = "articad.round/1"
Fate = Literal["kept", "regenerated", "new", "removed"]
_BORED: Final = "bore_axis"
_Signature = tuple[str, tuple[str, ...], str | None, str]


class Decision(ReplyForm):
    """Who must mend a fault."""

    fault: int
    route: Literal["design", "code"]
    part: str
    reason: str


class Decisions(ReplyForm):
    """One for each fault."""

    decisions: tuple[Decision, ...]


@dataclass(frozen=True)
class Repair:
    """What is to be made again.

    Attributes:
        design: What the designer is told; empty when the plan stands.
        code: What the authors of scripts are told, by part.
        stubborn: Those of `design` that came back after another attempt: they need another solution, not another number.
        stalled: Those that came back after every strategy; when there are any, nothing more is tried.
    """

    design: Findings = field(default_factory=Findings)
    code: Mapping[str, Findings] = field(default_factory=dict)
    stubborn: Findings = field(default_factory=Findings)
    stalled: Findings = field(default_factory=Findings)

    def to_json(self, number: int, fates: Mapping[str, Fate]) -> dict[str, Any]:
        """Return `rounds/<number>.json`: what was found, who mended it, and what became of each part.

        Args:
            number: The round whose findings these are, from 1.
            fates: By part, of the round after it.
        """
        by_fate = {fate: [name for name, found in fates.items() if found == fate] for fate in ("kept", "regenerated", "new", "removed")}
        return {
            "schema": SCHEMA,
            "round": number,
            "design": [finding.to_json() for finding in self.design],
            "code": {name: [finding.to_json() for finding in findings] for name, findings in self.code.items()},
            "stalled": [finding.to_json() for finding in self.stalled],
        } | by_fate


class Router:
    """Sends failures of one run to who must mend them, and knows what was tried.

    Args:
        llm: Who is asked where geometry does not tell.
    """

    def __init__(self, llm: LLM) -> None:
        self._llm = llm
        self._tried: dict[_Signature, list[str]] = {}

    def due(self, findings: Iterable[Finding]) -> list[Finding]:
        """Return what must be sent to somebody: errors, and once each what an inspector has against a part's entry in the plan."""
        return [
            finding
            for finding in findings
            if finding.severity == "error"
            or (_is_opinion(finding) and finding.route == "design" and _signature(finding) not in self._tried)
        ]

    def decide(self, number: int, findings: Iterable[Finding], resolved: ResolvedPlan, scripts: Mapping[str, bytes]) -> Repair:
        """Decide about what is due of a round.

        Args:
            number: The round, from 1.
            findings: What it found.
            resolved: The plan.
            scripts: Of the parts that were built, by name.

        Raises:
            OutputError: If a model must be asked and does not find the form.
        """
        failures = self.due(findings)
        routes = {index: _route(finding, resolved, scripts) for index, finding in enumerate(failures)}
        open_ones = [index for index, route in routes.items() if route is None]
        if open_ones:
            routes |= self._asked(number, open_ones, failures, resolved, scripts)
        design: list[Finding] = []
        stubborn: list[Finding] = []
        stalled: list[Finding] = []
        code: dict[str, list[Finding]] = {}
        for index, finding in enumerate(failures):
            tried = self._tried.setdefault(_signature(finding), [])
            if len(tried) > 1:
                stalled.append(finding)
                continue
            part = routes[index] or ""
            if tried:  # another strategy than last time
                stubborn += [finding] if tried == ["design"] else []
                part = ""
            tried.append("code" if part else "design")
            if part:
                code.setdefault(part, []).append(finding)
            else:
                design.append(finding)
        by_part = {name: Findings(mine) for name, mine in code.items()}
        return Repair(Findings(design), by_part, Findings(stubborn), Findings(stalled))

    def _asked(
        self, number: int, faults: Sequence[int], failures: Sequence[Finding], resolved: ResolvedPlan, scripts: Mapping[str, bytes]
    ) -> dict[int, str]:
        """Return whose script each fault is, or an empty name where it is the plan, as a model decides."""
        concerned = list(
            dict.fromkeys(_source(name, resolved) for index in faults for name in failures[index].parts if name in resolved.parts)
        )
        lines = ["The faults:", "", *(f"{place}. {failures[index]}" for place, index in enumerate(faults, 1))]
        for name in concerned:
            script = scripts.get(name, b"").decode()
            lines += ["", f"Part {name}. Its entry:", "", specification(resolved, name), "", "Its script:", "", f"```python\n{script}```"]

        def read(text: str, step: str) -> Decisions:
            decisions = reader(Decisions)(text, step)
            if sorted(one.fault for one in decisions.decisions) != list(range(1, len(faults) + 1)):
                raise unusable(f"one decision each is wanted for the faults 1 to {len(faults)}.", text, step=step)
            for one in decisions.decisions:
                if one.route == "code" and one.part not in scripts:
                    raise unusable(f'{one.part!r} has no script; "part" is one of {", ".join(concerned)}.', text, step=step)
            return decisions

        opening = (system(prompt("rollback")), user("\n".join(lines)))
        answer = ask(self._llm, "rollback", f"rollback/{number}", opening, read, schema=schema_of(Decisions))
        return {faults[one.fault - 1]: one.part if one.route == "code" else "" for one in answer.decisions}


def _route(finding: Finding, resolved: ResolvedPlan, scripts: Mapping[str, bytes]) -> str | None:
    """Return whose script a finding is, an empty name where it is the plan's, or None where that is open."""
    if finding.route == "design":
        return ""
    if finding.route is None:
        return None
    part = _culprit(finding, resolved)
    return part if part in scripts else None


def _culprit(finding: Finding, resolved: ResolvedPlan) -> str | None:
    """Return the part whose script must be mended: the one that is named, the only one, or of two the one with the bore."""
    named = finding.where.removeprefix("parts.").split(".", maxsplit=1)[0]
    if finding.where.startswith("parts.") and named in resolved.parts:
        return _source(named, resolved)
    parts = [name for name in finding.parts if name in resolved.parts]
    if len(parts) == 1:
        return _source(parts[0], resolved)
    bored = {
        side
        for joint in resolved.joints
        if {joint.parent, joint.child} == set(parts)
        for side, connector in ((joint.parent, joint.parent_connector), (joint.child, joint.child_connector))
        if resolved.parts[side].connectors[connector].kind == _BORED
    }
    return _source(bored.pop(), resolved) if len(bored) == 1 else None


def _source(name: str, resolved: ResolvedPlan) -> str:
    """Return the part that has the script: a derived part's faults are its source's."""
    while (derivation := resolved.parts[name].derivation) is not None:
        name = derivation.source
    return name


def _is_opinion(finding: Finding) -> bool:
    return finding.code.startswith("W_LOOK_")


def _signature(finding: Finding) -> _Signature:
    """Return what makes a finding the same as an earlier one: a fault that has become smaller is another."""
    value = "" if finding.value is None else f"{finding.value:.2g}"
    return finding.code, tuple(sorted(finding.parts)), finding.cause, value
