"""The report of an interference check: a verdict for every pair, and how strong each verdict is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, Self

from articad.findings import Findings
from articad.interference.relations import Relation

Verdict = Literal["clear", "contact", "overlap", "unknown"]

_DIGITS = 6


@dataclass(frozen=True)
class Strength:
    """How strong a verdict is: proven, sampled, waived or absent.

    Attributes:
        kind: "certified", "sampled", "waived" or "not_checked".
        epsilon: For a proof: largest distance of the solids from what was proven [mm].
        poses: For samples: their number.
        step: For samples along one joint: the distance of two [rad or mm]; None for a single pose or scattered ones.
        reason: For a waiver, or why nothing was checked.
    """

    kind: Literal["certified", "sampled", "waived", "not_checked"]
    epsilon: float | None = None
    poses: int | None = None
    step: float | None = None
    reason: str = ""

    @classmethod
    def certified(cls, epsilon: float) -> Self:
        """Proven up to `epsilon` [mm]."""
        return cls("certified", epsilon=epsilon)

    @classmethod
    def sampled(cls, poses: int, step: float | None = None) -> Self:
        """Sampled at this many poses."""
        return cls("sampled", poses=poses, step=step)

    @classmethod
    def waived(cls, reason: str) -> Self:
        """Allowed by the plan."""
        return cls("waived", reason=reason)

    @classmethod
    def not_checked(cls, reason: str) -> Self:
        """Not known."""
        return cls("not_checked", reason=reason)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report."""
        match self.kind:
            case "certified":
                return {"kind": self.kind, "epsilon_mm": rounded(self.epsilon)}
            case "sampled":
                return {"kind": self.kind, "poses": self.poses, "step": rounded(self.step)}
            case _:
                return {"kind": self.kind, "reason": self.reason}

    def __str__(self) -> str:
        match self.kind:
            case "certified":
                return f"certified({self.epsilon:.3g} mm)"
            case "sampled":
                return f"sampled({self.poses})"
            case _:
                return f"{self.kind.replace('_', ' ')}({self.reason})"


@dataclass(frozen=True)
class PairCheck:
    """The verdict on one pair of parts.

    Attributes:
        parts: Their names, in the order of the mechanism.
        relation: "mating" when a joint connects them, "rigid" when only fixed joints do, else "unrelated".
        over: "rest", "pose", or the names of the joints that moved.
        strength: How strong the verdict is.
        volume: Largest overlap [mm³].
        depth: Deepest overlap [mm].
        allowed: Depth up to which there is no finding [mm].
        gap: Smallest distance of the surfaces [mm]; None where it was not measured.
        verdict: "clear" if they have no common point, "contact" within what is allowed, "overlap" beyond it, or "unknown".
        pose: Pose of the worst overlap [rad, mm]; None at rest.
    """

    parts: tuple[str, str]
    relation: Relation
    over: str | tuple[str, ...]
    strength: Strength
    volume: float = 0.0
    depth: float = 0.0
    allowed: float = 0.0
    gap: float | None = None
    verdict: Verdict = "clear"
    pose: Mapping[str, float] | None = None

    def to_json(self) -> dict[str, Any]:
        """Return the JSON object of a report."""
        return {
            "parts": list(self.parts),
            "relation": self.relation,
            "over": self.over if isinstance(self.over, str) else list(self.over),
            "strength": self.strength.to_json(),
            "volume_mm3": rounded(self.volume),
            "depth_mm": rounded(self.depth),
            "allowed_mm": rounded(self.allowed),
            "gap_mm": rounded(self.gap),
            "verdict": self.verdict,
        }


class FitRow(Protocol):
    """The result for one fit."""

    @property
    def joint(self) -> str: ...  # noqa: D102
    def to_json(self) -> dict[str, Any]: ...  # noqa: D102


@dataclass(frozen=True)
class Checks:
    """The report of an interference check.

    Attributes:
        findings: All of them.
        pairs: Every pair that could meet or was requested; the bounding boxes of any other pair do not meet.
        deflection: Largest distance of any mesh from its solid [mm].
        over: "rest", "pose", or the names of the joints that moved.
        parts: All parts that have geometry.
        without_geometry: Parts that have none, so that they cannot overlap anything.
        fits: Declared fits compared with measurements, in the order of the joints.
    """

    findings: Findings
    pairs: tuple[PairCheck, ...]
    deflection: float
    over: str | tuple[str, ...] = "rest"
    parts: tuple[str, ...] = field(default=())
    without_geometry: tuple[str, ...] = field(default=())
    fits: tuple[FitRow, ...] = field(default=())

    @property
    def ok(self) -> bool:
        """True if nothing is wrong and everything that was requested was done."""
        return self.findings.ok

    @property
    def deepest(self) -> float:
        """Depth of the deepest overlap of all pairs, allowed ones included [mm]."""
        return max((pair.depth for pair in self.pairs), default=0.0)

    def pair(self, a: str, b: str) -> PairCheck | None:
        """Return the worst verdict on two parts; None when their bounding boxes do not meet."""
        found = [pair for pair in self.pairs if set(pair.parts) == {a, b}]
        return max(found, key=lambda pair: (("clear", "contact", "unknown", "overlap").index(pair.verdict), pair.depth), default=None)

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.checks/1`."""
        return {
            "schema": "articad.checks/1",
            "ok": self.ok,
            "findings": [finding.to_json() for finding in self.findings],
            "deflection_mm": rounded(self.deflection),
            "pairs": [pair.to_json() for pair in self.pairs],
            **({"fits": [row.to_json() for row in self.fits]} if self.fits else {}),
        }

    def _repr_html_(self) -> str:
        """Return the tables by which a notebook shows the report."""
        from articad.report.tables import html_table  # noqa: PLC0415 - what a notebook shows, loaded when it is shown

        rows = [(" – ".join(p.parts), ", ".join(_names(p.over)), p.verdict, str(p.strength), p.depth, p.gap) for p in self.pairs]
        pairs = html_table(["parts", "over", "verdict", "how that is known", "depth mm", "gap mm"], rows, numbers=(4, 5))
        return f"<p>{'ok' if self.ok else 'NOT ok'}</p>{self.findings._repr_html_() if len(self.findings) else ''}{pairs}"

    def __add__(self, other: Checks) -> Checks:
        """Return both reports as one; equal statements about a fit occur once."""
        told = [finding for finding in other.findings if not (finding.where.endswith(".fit") and finding in tuple(self.findings))]
        over = tuple(dict.fromkeys(_names(self.over) + _names(other.over)))
        return Checks(
            Findings([*self.findings, *told]),
            self.pairs + other.pairs,
            max(self.deflection, other.deflection),
            over,
            tuple(dict.fromkeys(self.parts + other.parts)),
            tuple(dict.fromkeys(self.without_geometry + other.without_geometry)),
            tuple({row.joint: row for row in (*self.fits, *other.fits)}.values()),
        )


def rounded(number: float | None) -> float | None:
    """Round to the digits that a report shows."""
    return None if number is None else float(f"{number:.{_DIGITS}g}")


def _names(over: str | tuple[str, ...]) -> tuple[str, ...]:
    return (over,) if isinstance(over, str) else over
