"""Findings: the results of checks, as values.

A finding is never raised by itself: checks return all findings at once, and exceptions (`articad.errors`)
carry the finding of the same cause when the work cannot continue. Forms: `docs/reference/findings.md`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, overload

from articad.findings.codes import CODES

Severity = Literal["error", "warning", "info"]
Route = Literal["design", "code"]
Stage = Literal["plan", "build", "interference", "motion", "fit", "export", "import", "audit", "model"]

MOST_CHARACTERS = 10_000
"""Of a message, a hint or a place; of longer ones the middle is left out."""

_SEVERITY_OF_PREFIX: dict[str, Severity] = {"E": "error", "W": "warning", "I": "info"}
_SEVERITY_ORDER = {"error": 0, "warning": 1, "info": 2}
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")
_SAID = 2e-3  # relative difference up to which a number in a message counts as the same
_SIGNIFICANT_DIGITS = 6  # reports are for people, and must not depend on the last bits of numbers


def bounded(text: str) -> str:
    """Return a text without its middle if it is longer than MOST_CHARACTERS: names in somebody's file may have millions of characters."""
    if len(text) <= MOST_CHARACTERS:
        return text
    end = MOST_CHARACTERS // 4
    return f"{text[: 2 * end]} … [{len(text) - 3 * end} characters are left out] … {text[-end:]}"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing that a check found.

    Attributes:
        code: Key of `articad.findings.codes.CODES`; its first letter is the severity.
        where: Path in the plan (`joints.lid_hinge`), a file, or an XPath.
        message: What is wrong, with names and numbers; one sentence.
        hint: What would be valid; what to change, to which value.
        parts: Names of the parts concerned.
        value: The measured number, in `unit`.
        limit: The tolerance or bound it was compared with, in `unit`.
        unit: Unit of `value` and `limit`.
        cause: Root cause, if geometry shows it.
        pose: Coordinates at which it was found [rad, mm], by coordinate name.
        stage: Which check found it; by default the one registered with the code.
        route: Who must act, the plan's author or a script's; by default the one registered with the code.
    """

    code: str
    where: str
    message: str
    hint: str
    parts: tuple[str, ...] = ()
    value: float | None = None
    limit: float | None = None
    unit: str | None = None
    cause: str | None = None
    pose: Mapping[str, float] | None = None
    stage: Stage | None = None
    route: Route | None = None

    def __post_init__(self) -> None:
        registered = CODES[self.code]
        for text in ("where", "message", "hint"):
            object.__setattr__(self, text, bounded(getattr(self, text)))
        if self.stage is None:
            object.__setattr__(self, "stage", registered.stage)
        if self.route is None:
            object.__setattr__(self, "route", registered.route)

    @property
    def severity(self) -> Severity:
        """The severity that the first letter of the code states."""
        return _SEVERITY_OF_PREFIX[self.code[0]]

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report, numbers rounded to 6 significant digits."""
        return {
            "code": self.code,
            "severity": self.severity,
            "stage": self.stage,
            "where": self.where,
            "parts": list(self.parts),
            "value": _rounded(self.value),
            "limit": _rounded(self.limit),
            "unit": self.unit,
            "message": self.message,
            "hint": self.hint,
            "cause": self.cause,
            "route": self.route,
            "pose": None if self.pose is None else {name: _rounded(q) for name, q in self.pose.items()},
        }

    def __str__(self) -> str:
        return f"{self.code} {self.where}: {self.message} {self.hint}".rstrip()


class Findings(Sequence[Finding]):
    """All findings of a check, sorted by severity, stage, place and code; equal ones appear once."""

    def __init__(self, findings: Iterable[Finding] = ()) -> None:
        unique = {str(finding.to_json()): finding for finding in findings}
        self._findings = tuple(sorted(unique.values(), key=_order))

    @property
    def ok(self) -> bool:
        """True when no finding is an error."""
        return not self.errors

    @property
    def errors(self) -> tuple[Finding, ...]:
        """The findings that are errors."""
        return tuple(finding for finding in self if finding.severity == "error")

    @property
    def codes(self) -> tuple[str, ...]:
        """The codes, in order."""
        return tuple(finding.code for finding in self)

    def of(self, *codes: str) -> tuple[Finding, ...]:
        """Return the findings with one of these codes."""
        return tuple(finding for finding in self if finding.code in codes)

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.findings/1`."""
        return {"schema": "articad.findings/1", "ok": self.ok, "findings": [finding.to_json() for finding in self]}

    def __add__(self, others: Iterable[Finding]) -> Findings:
        return Findings((*self, *others))

    @overload
    def __getitem__(self, index: int) -> Finding: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Finding, ...]: ...
    def __getitem__(self, index: int | slice) -> Finding | tuple[Finding, ...]:
        return self._findings[index]

    def __len__(self) -> int:
        return len(self._findings)

    def __iter__(self) -> Iterator[Finding]:
        return iter(self._findings)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Findings) and self.to_json() == other.to_json()

    def __hash__(self) -> int:
        return hash(self.codes)

    def __str__(self) -> str:
        return "\n".join(map(str, self)) or "no findings"

    def __repr__(self) -> str:
        return f"Findings({list(self.codes)})"

    def _repr_html_(self) -> str:
        """Return the table of findings for a notebook."""
        from articad.report.tables import html_table  # noqa: PLC0415 - what a notebook shows, loaded when it is shown

        rows = [(finding.code, finding.where, finding.message, finding.hint) for finding in self]
        return html_table(["code", "where", "what", "hint"], rows) or "<p>no findings</p>"


def relocated(finding: Finding, where: str) -> Finding:
    """Return the finding at another place, as when a part's own check is reported for a whole plan."""
    return replace(finding, where=where)


def _order(finding: Finding) -> tuple[int, str, str, str, str]:
    return (_SEVERITY_ORDER[finding.severity], str(finding.stage), finding.where, finding.code, finding.message)


def _rounded(number: float | None) -> float | None:
    """Round to the digits a report shows; a number that JSON cannot hold becomes null."""
    if number is None or not math.isfinite(number):
        return None
    return float(f"{number:.{_SIGNIFICANT_DIGITS}g}")


def measured_against(finding: Mapping[str, Any]) -> str:
    """Return what was measured and the limit, such as ` (5.3 against 0.12 mm)`; empty if the message contains the number itself.

    Args:
        finding: A finding of a report.
    """
    value, limit = finding.get("value"), finding.get("limit")
    if value is None or limit is None:
        return ""
    if any(abs(float(said) - abs(value)) <= _SAID * abs(value) for said in _NUMBER.findall(finding["message"])):
        return ""
    return f" ({value:.6g} against {limit:.6g} {finding.get('unit') or ''}".rstrip() + ")"
