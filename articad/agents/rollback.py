"""Rollback: who must fix a failure, and what is to be made again.

Geometry decides first: a finding with a root cause says who must act, and a breach of a contract belongs to its script. A model is asked
only where geometry leaves this open. A finding that comes back takes another way: if a script did not resolve it, it goes to the
designer; if the designer did not, it goes back with the demand for another solution; the third time ends the attempts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

from articad.agents.design import DOUBTS
from articad.agents.llm import LLM, system, user
from articad.agents.orders import is_fault_of_joint, source_of
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of, unusable
from articad.findings import Finding, Findings
from articad.plan.entry import specification
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
        design: Findings for the designer; empty if the plan stays.
        code: Findings for the authors of scripts, by part.
        stubborn: Those of `design` that came back after an attempt: they need another solution, not another number.
        stalled: Those that came back after every strategy; if there are any, nothing more is tried.
    """

    design: Findings = field(default_factory=Findings)
    code: Mapping[str, Findings] = field(default_factory=dict)
    stubborn: Findings = field(default_factory=Findings)
    stalled: Findings = field(default_factory=Findings)

    def to_json(self, number: int, fates: Mapping[str, Fate]) -> dict[str, Any]:
        """Return `rounds/<number>.json`: the findings, who resolved them, and what became of each part.

        Args:
            number: The round of these findings, from 1.
            fates: What became of each part in the round after it.
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
    """Routes the failures of a run to whoever must fix them, and remembers what was tried.

    Args:
        llm: The model that decides where geometry does not.
    """

    def __init__(self, llm: LLM) -> None:
        self._llm = llm
        self._tried: dict[_Signature, list[str]] = {}

    def due(self, findings: Iterable[Finding]) -> list[Finding]:
        """Return the findings to be routed: errors, and once each doubts about the plan, an inspector's complaints about it, and faults of joints."""
        return [
            finding
            for finding in findings
            if finding.severity == "error" or (_is_due_once(finding) and _signature(finding) not in self._tried)
        ]

    def noted(self, opinions: Iterable[Finding]) -> None:
        """Take note of opinions that the designer has been told already: they are not due again."""
        for finding in opinions:
            self._tried.setdefault(_signature(finding), []).append("design")

    def decide(
        self, number: int, findings: Iterable[Finding], resolved: ResolvedPlan, scripts: Mapping[str, bytes], *, every: bool = False
    ) -> Repair:
        """Decide who must act on a round's findings.

        Args:
            number: The round, from 1.
            findings: What it found.
            resolved: The plan.
            scripts: Of the parts that were built, by name.
            every: Whether all findings are due, as those of parts that could not be made are.

        Raises:
            OutputError: If a model must be asked and its replies do not have the form.
        """
        failures = list(findings) if every else self.due(findings)
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
        """Return the part whose script causes each fault, or an empty name for the plan, as a model decides."""
        concerned = list(
            dict.fromkeys(source_of(name, resolved) for index in faults for name in failures[index].parts if name in resolved.parts)
        )
        lines = ["The faults:", "", *(f"{place}. {failures[index]}" for place, index in enumerate(faults, 1))]
        for name in concerned:
            script = scripts.get(name, b"").decode()
            lines += ["", f"Part {name}. Its entry:", "", specification(resolved, name), "", "Its script:", "", f"```python\n{script}```"]

        def read(text: str, step: str) -> Decisions:
            decisions = reader(Decisions)(text, step)
            if sorted(one.fault for one in decisions.decisions) != list(range(1, len(faults) + 1)):
                raise unusable(f"exactly one decision is needed for each of the faults 1 to {len(faults)}.", text, step=step)
            for one in decisions.decisions:
                if one.route == "code" and one.part not in scripts:
                    raise unusable(f'{one.part!r} has no script; "part" is one of {", ".join(concerned)}.', text, step=step)
            return decisions

        opening = (system(prompt("rollback")), user("\n".join(lines)))
        answer = ask(self._llm, "rollback", f"rollback/{number}", opening, read, schema=schema_of(Decisions))
        return {faults[one.fault - 1]: one.part if one.route == "code" else "" for one in answer.decisions}


def _route(finding: Finding, resolved: ResolvedPlan, scripts: Mapping[str, bytes]) -> str | None:
    """Return the part whose script must be fixed, an empty name for the plan, or None if that is open."""
    if finding.route == "design":
        return ""
    if finding.route is None:
        return None
    part = _culprit(finding, resolved)
    return part if part in scripts else None


def _culprit(finding: Finding, resolved: ResolvedPlan) -> str | None:
    """Return the part whose script must be fixed: the one that is named, the only one, or of two the one with the bore."""
    named = finding.where.removeprefix("parts.").split(".", maxsplit=1)[0]
    if finding.where.startswith("parts.") and named in resolved.parts:
        return source_of(named, resolved)
    parts = [name for name in finding.parts if name in resolved.parts]
    if len(parts) == 1:
        return source_of(parts[0], resolved)
    bored = {
        side
        for joint in resolved.joints
        if {joint.parent, joint.child} == set(parts)
        for side, connector in ((joint.parent, joint.parent_connector), (joint.child, joint.child_connector))
        if resolved.parts[side].connectors[connector].kind == _BORED
    }
    return source_of(bored.pop(), resolved) if len(bored) == 1 else None


def _is_due_once(finding: Finding) -> bool:
    """Return whether a finding is a warning that someone must answer once."""
    is_opinion = finding.code.startswith("W_LOOK_") or finding.code in DOUBTS
    return is_fault_of_joint(finding) or (is_opinion and finding.route == "design")


def _signature(finding: Finding) -> _Signature:
    """Return what identifies a finding with an earlier one; a fault that has become smaller counts as a new one."""
    if is_fault_of_joint(finding):  # asked about once, however large it is then
        return finding.code, (finding.where,), finding.cause, ""
    value = "" if finding.value is None else f"{finding.value:.2g}"
    return finding.code, tuple(sorted(finding.parts)), finding.cause, value
