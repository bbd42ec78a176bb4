"""The measurements of a simulation, and the verdict on them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from articad.findings import Finding, Findings

SHARE = 0.99  # of its range that every joint must reach
CALM = 0.02  # rad/s or m/s: slower is at rest
DRIFT = 0.05  # rad or m by which a held joint may be pushed away
RESIDUAL = 1e-3  # m or rad by which a closed loop may be open
_NAMED = 4  # links in one message
GROWTH = 0.05  # of the largest kinetic energy: more than integration errors

Role = Literal["free", "driver", "follower", "tied"]


@dataclass(frozen=True)
class JointReach:
    """How far a joint moved.

    Attributes:
        joint: Its name.
        lower: What it should reach [rad or m]: its own bound; for a follower, where its drivers bring it.
        upper: Likewise.
        low: What it reached, whichever joint of its loop was driven.
        high: Likewise.
        share: Share of the range that was reached.
        unit: "rad" or "m".
        blocker: Bodies that touched where it lagged most.
        role: "free" outside of loops; "driver" and "follower" in a loop with known drivers; "tied" in one with unknown drivers.
        loop: Joints with the same number move together.
        allowed: Range of a driver according to kinematics [rad or m], if that is less than its own bounds.
    """

    joint: str
    lower: float
    upper: float
    low: float
    high: float
    share: float
    unit: str
    blocker: str = ""
    role: Role = "free"
    loop: int | None = None
    allowed: tuple[float, float] | None = None


def covered(low: float, high: float, lower: float, upper: float) -> float:
    """Return the share of a range that was reached."""
    return max((min(high, upper) - max(low, lower)) / (upper - lower), 0.0) if upper > lower else 1.0


@dataclass(frozen=True)
class FilmFrame:
    """A frame of the film: the joint that was driven, and the values of all [rad, m]."""

    joint: str
    values: dict[str, float]


@dataclass
class EngineOutcome:
    """Measurements of one engine.

    Attributes:
        engine: "mujoco" or "pybullet".
        version: Its version.
        loads: Whether it loaded the model; None if it is not installed or did not finish.
        message: Its own message, if it did not.
        speed_at_rest: Largest speed at the end of holding [rad/s or m/s].
        moved_at_rest: Largest displacement of a held joint [rad or m].
        top_speed: Largest speed overall [rad/s or m/s].
        exploded: True if numbers diverged.
        residual: Largest residual of equality constraints [m or rad].
        energy_growth: Growth of energy as a share of the largest kinetic energy; None if it was not measured.
        reaches: Results by joint.
        untried: Joints that were left out because there were too many.
        frames: Frames for a filmstrip.
        open_loops: Closed loops, or equality constraints, that the file or the engine leaves out.
        passed_over: Joints that were not driven, because the loop that leads them is open.
        unread: Links whose inertia the engine did not read from the file, so that nothing was tried.
        late: Time after which it was stopped [s], so that nothing is known.
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
    reaches: list[JointReach] = field(default_factory=list)
    untried: int = 0
    frames: list[FilmFrame] = field(default_factory=list)
    open_loops: int = 0
    passed_over: tuple[str, ...] = ()
    unread: tuple[str, ...] = ()
    late: float | None = None

    @property
    def judged(self) -> list[JointReach]:
        """Joints that have to reach their range.

        In a loop with unknown drivers, any joint may only follow: the joint that comes farthest represents all. If a driver falls short,
        only the driver is reported, not its followers.
        """
        short = {reach.loop for reach in self.reaches if reach.role == "driver" and reach.share < SHARE}
        best: dict[int | None, JointReach] = {}
        for reach in self.reaches:
            if reach.role == "tied" and (reach.loop not in best or reach.share > best[reach.loop].share):
                best[reach.loop] = reach
        passed_over = [reach for reach in self.reaches if reach.role == "tied" and reach is not best[reach.loop]]
        passed_over += [reach for reach in self.reaches if reach.role == "follower" and reach.loop in short]
        return [reach for reach in self.reaches if reach not in passed_over]

    def to_json(self) -> dict[str, Any]:
        """Return the row of a report; frames are left out."""
        row = asdict(self)
        del row["frames"]
        return row

    @classmethod
    def from_json(cls, row: dict[str, Any]) -> EngineOutcome:
        """Return the measurements of another process."""
        reaches = [JointReach(**reach | {"allowed": reach.get("allowed") and tuple(reach["allowed"])}) for reach in row.pop("reaches", [])]
        frames = [FilmFrame(**frame) for frame in row.pop("frames", [])]
        passed_over, unread = tuple(row.pop("passed_over", ())), tuple(row.pop("unread", ()))
        return cls(**row, reaches=reaches, frames=frames, passed_over=passed_over, unread=unread)


@dataclass(frozen=True)
class SimulationVerdict:
    """The verdict on one model."""

    file: str
    outcomes: tuple[EngineOutcome, ...]

    @property
    def findings(self) -> Findings:
        """The findings."""
        return Findings(finding for outcome in self.outcomes for finding in _findings(outcome))

    @property
    def ok(self) -> bool:
        """True if an engine tried it and nothing is wrong."""
        return self.findings.ok and any(outcome.loads and not outcome.unread for outcome in self.outcomes)

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.simulation/1`."""
        return {
            "schema": "articad.simulation/1",
            "ok": self.ok,
            "file": self.file,
            "findings": [finding.to_json() for finding in self.findings],
            "engines": [outcome.to_json() for outcome in self.outcomes],
        }


def _findings(outcome: EngineOutcome) -> Iterator[Finding]:
    name = {"mujoco": "MuJoCo", "pybullet": "PyBullet"}.get(outcome.engine, outcome.engine)
    if outcome.late is not None:
        yield Finding(
            code="W_SIM_NOT_TRIED",
            where=outcome.engine,
            message=f"{name} did not finish within {outcome.late:g} s and was stopped, so it says nothing about the model.",
            hint="Run `articad sim` on the file with more `--seconds`, or while the machine does less.",
            value=outcome.late,
            unit="s",
        )
        return
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
    if outcome.unread:
        shown = ", ".join(outcome.unread[:_NAMED]) + (f" and {len(outcome.unread) - _NAMED} more" if len(outcome.unread) > _NAMED else "")
        yield Finding(
            code="I_SIM_UNREAD",
            where=outcome.engine,
            message=f"{name} reads no inertia of {shown} from this file, so nothing was tried there.",
            hint=f"Simulate a URDF of the model in {name}.",
            value=len(outcome.unread),
        )
        return
    if outcome.exploded:
        yield Finding(
            code="E_SIM_EXPLODES",
            where=outcome.engine,
            message=f"In {name} the simulation diverged: a joint reached {outcome.top_speed:.4g} rad/s or m/s.",
            hint="Check for overlap at rest and for impossible inertias with `articad audit`; use a smaller time step.",
            value=outcome.top_speed,
        )
        return
    if outcome.speed_at_rest > CALM or outcome.moved_at_rest > DRIFT:
        speed = outcome.speed_at_rest > CALM
        yield Finding(
            code="E_SIM_UNSETTLED",
            where=outcome.engine,
            message=f"In {name}, with all joints held at rest, a joint "
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
    if outcome.open_loops:
        told = f"; {', '.join(outcome.passed_over)} were not driven" if outcome.passed_over else ", their joints free"
        yield Finding(
            code="I_SIM_LOOPS_OPEN",
            where=outcome.engine,
            message=f"{outcome.open_loops} closed loops or couplings of the model are left out in {name}{told}.",
            hint="Simulate the MJCF in MuJoCo, which closes them.",
        )
    if (outcome.energy_growth or 0.0) > GROWTH:
        yield Finding(
            code="E_SIM_ENERGY",
            where=outcome.engine,
            message=f"In {name}, after release, the model gains {100 * (outcome.energy_growth or 0.0):.4g} % of its largest kinetic energy.",
            hint="Use a smaller time step, and check inertias, springs and damping.",
            value=100 * (outcome.energy_growth or 0.0),
            limit=100 * GROWTH,
            unit="%",
        )


def _short_reaches(outcome: EngineOutcome, engine: str) -> Iterator[Finding]:
    """Return findings about joints that do not reach their range."""
    for reach in outcome.judged:
        if reach.share >= SHARE:
            continue
        scale, unit = (180 / math.pi, "deg") if reach.unit == "rad" else (1000.0, "mm")
        low, high, lower, upper = (value * scale for value in (reach.low, reach.high, reach.lower, reach.upper))
        of = f"of {lower:.4g} to {upper:.4g} {unit}"
        if reach.role == "follower":
            of += ", which follows from its drivers"
        message = f"In {engine} {reach.joint} reaches {100 * reach.share:.3g} % of its range: {low:.4g} to {high:.4g} {of}"
        if reach.allowed is not None:
            message += f", of which its loop allows {reach.allowed[0] * scale:.4g} to {reach.allowed[1] * scale:.4g}"
        yield Finding(
            code="E_SIM_RANGE",
            where=f"joints.{reach.joint}",
            parts=tuple(reach.blocker.split(" and ")) if reach.blocker else (),
            message=f"{message}; {reach.blocker} touch." if reach.blocker else f"{message}.",
            hint=_advice(reach),
            value=100 * reach.share,
            limit=100 * SHARE,
            unit="%",
            cause="collision" if reach.blocker else None,
        )


def _advice(reach: JointReach) -> str:
    if reach.allowed is not None and covered(reach.low, reach.high, *reach.allowed) >= SHARE:
        return "Declare the range that the loop allows; `articad check` names what limits it."
    if reach.blocker:
        return "Add clearance or narrow the range; MuJoCo uses the convex hulls of meshes for collision, which fill holes and slots."
    return "Check for a limit, spring or constraint that stops it."
