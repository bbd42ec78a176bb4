"""Exceptions: raised when the work cannot go on. Findings that are merely reported live in `articad.findings`.

ArticadError
├─ PlanError
├─ ConnectorError
├─ KinematicsError
│  ├─ UnknownJointError
│  ├─ LimitError
│  ├─ LoopError
│  └─ DeadPointError
├─ KernelError
│  ├─ BuildError
│  ├─ ContractError
│  ├─ InvalidSolidError
│  ├─ SandboxError
│  └─ KernelUnavailableError
├─ ReadError
├─ WriteError
├─ RunError
├─ ExportError
│  └─ UnrepresentableError
└─ AgentError
   ├─ OutputError
   ├─ ReplayMissError
   ├─ BudgetError
   └─ TransportError
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Self

from articad.findings import Finding, Findings, bounded


class ArticadError(Exception):
    """Base of all errors: what happened, where, and what would have been valid.

    Attributes:
        findings: The findings of the same cause; empty when the error concerns no plan, part or file.
        stage: The stage in which it happened.
        parts: The parts concerned.
    """

    default_stage = "plan"

    def __init__(self, message: str, *, findings: Iterable[Finding] = (), stage: str | None = None, parts: Iterable[str] = ()) -> None:
        self.message = bounded(message)
        super().__init__(self.message)
        self.findings = Findings(findings)
        self.stage = stage or (str(self.findings[0].stage) if self.findings else self.default_stage)
        self.parts = tuple(parts) or tuple(dict.fromkeys(part for finding in self.findings for part in finding.parts))

    def __str__(self) -> str:
        return self.message

    def __reduce__(self) -> tuple[object, ...]:
        """Let errors cross from one process to another, whatever their own arguments are."""
        return _restored, (type(self), self.args, self.__dict__)


def _restored(kind: type[ArticadError], arguments: tuple[object, ...], attributes: dict[str, object]) -> ArticadError:
    error = kind.__new__(kind, *arguments)
    error.__dict__.update(attributes)
    return error


class PlanError(ArticadError):
    """A plan that cannot be solved; `findings` holds every reason."""


class ConnectorError(ArticadError):
    """A malformed frame, axis or rotation."""


class KinematicsError(ArticadError):
    """A mechanism or configuration that cannot be solved."""


class UnknownJointError(KinematicsError):
    """A joint or coordinate that the mechanism does not have."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        self.name = name
        self.known = tuple(known)
        super().__init__(f"Unknown joint {name!r}.{did_you_mean(name, self.known)} Known: {', '.join(self.known) or 'none'}.")


class LimitError(KinematicsError):
    """A coordinate outside its joint's limits; `advice` says what would bring it back, where that is known."""

    def __init__(self, joint: str, value: float, lower: float, upper: float, unit: str = "rad", advice: str = "") -> None:
        self.joint, self.value, self.lower, self.upper, self.unit, self.advice = joint, value, lower, upper, unit, advice
        message = f"Joint {joint!r} is at {value:.6g} {unit}, outside its limits [{lower:.6g}, {upper:.6g}] {unit}."
        super().__init__(f"{message} {advice}" if advice else message)


class LoopError(KinematicsError):
    """A closed loop that cannot be closed; `gap` is the best one found [mm]."""

    def __init__(self, message: str, *, loop: tuple[str, ...] = (), gap: float = float("nan"), findings: Iterable[Finding] = ()) -> None:
        self.loop, self.gap = loop, gap
        super().__init__(message, findings=findings, parts=loop)


class DeadPointError(KinematicsError):
    """A driver that was to go beyond a dead point, which is at `q` [rad or mm]."""

    def __init__(self, message: str, *, driver: str, q: float, findings: Iterable[Finding] = ()) -> None:
        self.driver, self.q = driver, q
        super().__init__(message, findings=findings)


class KernelError(ArticadError):
    """A part that could not be built; `partial` is a folder with the mesh (part.npz) of the solids that its script had, if any."""

    default_stage = "build"
    partial: Path | None = None


class BuildError(KernelError):
    """A part script that failed; `line` is the script's own line, if it is known."""

    def __init__(
        self,
        message: str,
        *,
        script: str = "",
        line: int | None = None,
        traceback: str = "",
        findings: Iterable[Finding] = (),
        parts: Iterable[str] = (),
    ) -> None:
        self.script, self.line, self.traceback = script, line, traceback
        super().__init__(message, findings=findings, parts=parts)


class ContractError(KernelError):
    """A part that was built but breaks its contract; `findings` holds every breach at once."""


class InvalidSolidError(KernelError):
    """A solid or mesh that is not closed, oriented and finite; `status` says which."""

    def __init__(self, message: str, *, status: str, findings: Iterable[Finding] = (), parts: Iterable[str] = ()) -> None:
        self.status = status
        super().__init__(message, findings=findings, parts=parts)


class SandboxError(KernelError):
    """Isolation that is required but not available here."""


class KernelUnavailableError(KernelError):
    """A kernel that is not installed; the message says where it was looked for and how to install it."""

    def __init__(self, message: str, *, looked_in: Iterable[str] = (), how_to_get: str = "", findings: Iterable[Finding] = ()) -> None:
        self.looked_in, self.how_to_get = tuple(looked_in), how_to_get
        super().__init__(message, findings=findings)


class ReadError(ArticadError):
    """A file that cannot be read; `path` and `where` in it."""

    default_stage = "import"

    def __init__(self, message: str, *, path: str, where: str = "", findings: Iterable[Finding] = ()) -> None:
        self.path, self.where = path, where
        super().__init__(message, findings=findings)

    @classmethod
    def at(cls, where: object, message: str, hint: str, *, said: str | None = None) -> Self:
        """Return the error E_READ about one place; as a text it reads `said`, by default message and hint."""
        finding = Finding(code="E_READ", where=str(where), message=message, hint=hint)
        return cls(f"{message} {hint}" if said is None else said, path=str(where), findings=[finding])


class WriteError(ArticadError):
    """A file that cannot be written; `path` says which. Files that were written before are intact."""

    default_stage = "export"

    def __init__(self, message: str, *, path: str, findings: Iterable[Finding] = ()) -> None:
        self.path = path
        super().__init__(message, findings=findings)


class RunError(ArticadError):
    """A run directory that cannot be used: it is not one, belongs to another request, or is in use by another process."""

    default_stage = "import"

    def __init__(self, message: str, *, path: str, findings: Iterable[Finding] = ()) -> None:
        self.path = path
        super().__init__(message, findings=findings)

    @classmethod
    def at(cls, path: object, message: str, hint: str) -> Self:
        """Return the error E_RUN about a directory."""
        finding = Finding(code="E_RUN", where=str(path), message=message, hint=hint)
        return cls(f"{message} {hint}", path=str(path), findings=[finding])


class ExportError(ArticadError):
    """An assembly that cannot be written."""

    default_stage = "export"


class UnrepresentableError(ExportError):
    """Something that the format cannot hold; raised if `strict` was requested."""

    def __init__(self, joint: str, format_name: str, lost: str, *, findings: Iterable[Finding] = ()) -> None:
        self.joint, self.format_name, self.lost = joint, format_name, lost
        super().__init__(f"{format_name} cannot hold {joint!r}: {lost}. Export without strict to accept this loss.", findings=findings)


class AgentError(ArticadError):
    """A model that could not be asked, or whose answers could not be used."""

    default_stage = "model"


class OutputError(AgentError):
    """A reply that does not have the required form; `raw` is the reply."""

    def __init__(self, message: str, *, raw: str, findings: Iterable[Finding] = ()) -> None:
        self.raw = raw
        super().__init__(message, findings=findings)


class ReplayMissError(AgentError):
    """A request for which the recording has no reply."""

    def __init__(self, message: str, *, step: str, nearest: str | None = None, findings: Iterable[Finding] = ()) -> None:
        self.step, self.nearest = step, nearest
        super().__init__(message, findings=findings)


class BudgetError(AgentError):
    """A budget that is spent; `spent` says on what."""

    def __init__(self, message: str, *, spent: str, findings: Iterable[Finding] = ()) -> None:
        self.spent = spent
        super().__init__(message, findings=findings)

    def after(self, failure: AgentError) -> BudgetError:
        """Return this error with the reason why the last attempt within the budget failed."""
        findings = [replace(finding, message=f"{finding.message} {failure}") for finding in self.findings]
        return BudgetError(f"{self} {failure}", spent=self.spent, findings=findings)


class TransportError(AgentError):
    """A provider that could not be reached or refused the request."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ` Did you mean 'x'?` for the closest known name, or nothing."""
    close = difflib.get_close_matches(name, list(known), n=1, cutoff=0.6)
    return f" Did you mean {close[0]!r}?" if close else ""
