"""What was measured in a simulation, and the verdict on it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from typing import Any

from articad.findings import Finding, Findings

SHARE = 0.95  # of its range that every joint must reach
CALM = 0.02  # rad/s or m/s: slower is at rest
DRIFT = 0.05  # rad or m by which a held joint may be pushed away
RESIDUAL = 1e-3  # m or rad by which a closed loop may be open
GROWTH = 0.05  # of the largest kinetic energy: integration errors, no more


@dataclass(frozen=True)
class Reach:
    """How far a joint came.

    Attributes:
        joint: Its name.
        lower: What it was to reach [rad or m].
        upper: Likewise.
        low: What it reached.
        high: Likewise.
        share: Of the range.
        unit: "rad" or "m".
        blocker: Bodies that touched where it lagged most.
        tied: True for a joint of a closed loop.
    """

    joint: str
    lower: float
    upper: float
    low: float
    high: float
    share: float
    unit: str
    blocker: str = ""
    tied: bool = False


@dataclass(frozen=True)
class Frame:
    """A moment worth showing: which joint was driven, and the values of all [rad, m]."""

    joint: str
    values: dict[str, float]


@dataclass
class Outcome:
    """Measurements of one engine.

    Attributes:
        engine: "mujoco" or "pybullet".
        version: Of it.
        loads: Whether it took the model; None where it is not installed.
        message: Its own words, if it did not.
        speed_at_rest: Largest speed at the end of the time it was held [rad/s or m/s].
        moved_at_rest: By how far a held joint was pushed away [rad or m].
        top_speed: Largest speed of all [rad/s or m/s].
        exploded: True when numbers went wild.
        residual: Of equality constraints [m or rad].
        energy_growth: As a share of the largest kinetic energy; None where it was not measured.
        reaches: By joint.
        untried: Joints that there were too many of.
        frames: For a filmstrip.
    """

    engine: str
    version: str = ""
    loads: bool | None = True
    message: str = ""
    speed_at_rest: float = 0.0
    moved_at_rest: float = 0.0
    top_speed: float = 0.0
    exploded: bool = False
    residual: float = 0.0
    energy_growth: float | None = None
    reaches: list[Reach] = field(default_factory=list)
    untried: int = 0
    frames: list[Frame] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Return the row of a report; frames are left out."""
        row = asdict(self)
        del row["frames"]
        return row

    @classmethod
    def from_json(cls, row: dict[str, Any]) -> Outcome:
        """Return what another process measured."""
        reaches = [Reach(**reach) for reach in row.pop("reaches", [])]
        frames = [Frame(**frame) for frame in row.pop("frames", [])]
        return cls(**row, reaches=reaches, frames=frames)


@dataclass(frozen=True)
class Verdict:
    """The verdict on one model."""

    file: str
    outcomes: tuple[Outcome, ...]

    @property
    def findings(self) -> Findings:
        """What is wrong."""
        return Findings(finding for outcome in self.outcomes for finding in _findings(outcome))

    @property
    def ok(self) -> bool:
        """True when an engine tried it and nothing is wrong."""
        return self.findings.ok and any(outcome.loads for outcome in self.outcomes)

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.simulation/1`."""
        return {
            "schema": "articad.simulation/1",
            "ok": self.ok,
            "file": self.file,
            "findings": [finding.to_json() for finding in self.findings],
            "engines": [outcome.to_json() for outcome in self.outcomes],
        }


def _findings(outcome: Outcome) -> Iterator[Finding]:
    name = {"mujoco": "MuJoCo", "pybullet": "PyBullet"}.get(outcome.engine, outcome.engine)
    if outcome.loads is None:
        return
    if not outcome.loads:
        yield Finding(
            code="E_SIM_LOAD",
            where=outcome.engine,
            message=f"{name} {outcome.version} does not load the model: {outcome.message}",
            hint="Run `articad audit` on the file: it names the cause.",
        )
        return
    if outcome.exploded:
        yield Finding(
            code="E_SIM_EXPLODES",
            where=outcome.engine,
            message=f"In {name} the numbers went wild: a joint reached {outcome.top_speed:.4g} rad/s or m/s.",
            hint="Look for overlap at rest and for impossible inertias with `articad audit`.",
            value=outcome.top_speed,
        )
        return
    if outcome.speed_at_rest > CALM or outcome.moved_at_rest > DRIFT:
        speed = outcome.speed_at_rest > CALM
        yield Finding(
            code="E_SIM_UNSETTLED",
            where=outcome.engine,
            message=f"In {name}, held at rest, a joint "
            + (
                f"still moves at {outcome.speed_at_rest:.4g} rad/s or m/s"
                if speed
                else f"is pushed {outcome.moved_at_rest:.4g} rad or m away"
            )
            + ".",
            hint="Parts that overlap at rest push each other; see `articad audit`.",
            value=outcome.speed_at_rest if speed else outcome.moved_at_rest,
            limit=CALM if speed else DRIFT,
        )
    yield from _short_reaches(outcome, name)
    if outcome.residual > RESIDUAL:
        yield Finding(
            code="E_SIM_RESIDUAL",
            where=outcome.engine,
            message=f"In {name} a closed loop is open by {outcome.residual * 1000:.4g} mm (or mrad) at rest.",
            hint="Let the loop close at rest, or stiffen its constraint.",
            value=outcome.residual * 1000,
            limit=RESIDUAL * 1000,
            unit="mm",
        )
    if (outcome.energy_growth or 0.0) > GROWTH:
        yield Finding(
            code="E_SIM_ENERGY",
            where=outcome.engine,
            message=f"In {name}, let go, the model gains {100 * (outcome.energy_growth or 0.0):.4g} % of its largest kinetic energy.",
            hint="Use a smaller time step, and check inertias and springs.",
            value=100 * (outcome.energy_growth or 0.0),
            limit=100 * GROWTH,
            unit="%",
        )


def _short_reaches(outcome: Outcome, engine: str) -> Iterator[Finding]:
    """Joints that do not reach their range; of a loop without known drivers the best joint counts."""
    free = [reach for reach in outcome.reaches if not reach.tied]
    tied = [reach for reach in outcome.reaches if reach.tied]
    best = max(tied, key=lambda reach: reach.share, default=None)
    for reach in (*free, *([best] if best is not None else [])):
        if reach.share >= SHARE:
            continue
        scale, unit = (180 / math.pi, "deg") if reach.unit == "rad" else (1000.0, "mm")
        yield Finding(
            code="E_SIM_RANGE",
            where=f"joints.{reach.joint}",
            parts=tuple(reach.blocker.split(" and ")) if reach.blocker else (),
            message=f"In {engine} {reach.joint} reaches {100 * reach.share:.3g} % of its range: {reach.low * scale:.4g} to {reach.high * scale:.4g} "
            f"of {reach.lower * scale:.4g} to {reach.upper * scale:.4g} {unit}" + (f"; {reach.blocker} touch." if reach.blocker else "."),
            hint="Make room or narrow the range; MuJoCo collides with the convex hulls of meshes, which fill holes and slots."
            if reach.blocker
            else "Look for a limit, spring or constraint that stops it.",
            value=100 * reach.share,
            limit=100 * SHARE,
            unit="%",
            cause="collision" if reach.blocker else None,
        )
