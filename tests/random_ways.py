"""Ways that random mechanisms can go, followed by equations of the test's own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.pose_equations import PoseEquations, Solution
from tests.random_mechanisms import AFLOAT, Specimen, random_mechanism

FloatArray = NDArray[np.float64]

SOME, ALL = 50, 1050
SOME_AFLOAT, ALL_AFLOAT = 12, 150
SAMPLES = 3  # of each way
SPANS = (0.5, 1.5, 4.0, 8.0)  # rad: how far drivers are moved, some beyond a full turn


def seeds(some: int = SOME) -> list[Any]:
    """Seeds of random mechanisms, also of those with free joints; those beyond the first few are marked."""
    fixed = [seed if seed < some else pytest.param(seed, marks=pytest.mark.soak) for seed in range(ALL)]
    few = min(some, SOME_AFLOAT)
    return [*fixed, *(AFLOAT + k if k < few else pytest.param(AFLOAT + k, marks=pytest.mark.soak) for k in range(ALL_AFLOAT))]


@dataclass(frozen=True)
class Way:
    """Drivers that move together from rest, and where they are followed to: at least as far as is well posed and within limits.

    Attributes:
        drivers: Names of the coordinates that move.
        solutions: The truth along the way.
    """

    drivers: tuple[str, ...]
    solutions: list[Solution]


class Case:
    """A random mechanism, its own equations, and the ways of its drivers."""

    def __init__(self, seed: int) -> None:
        self.specimen: Specimen = random_mechanism(seed)
        self.mechanism = self.specimen.mechanism
        self.equations = PoseEquations(self.mechanism, self.specimen.rest, self.specimen.size)
        self.rng = np.random.default_rng([seed, 1])
        self.balls = [j for j in self.mechanism.joints if j.type.quaternion is not None and f"{j.name}.qw" in self._driving]
        self.ways = list(self._ways())

    @property
    def _driving(self) -> list[str]:
        return [c.name for c in self.mechanism.drivers]

    def q(self, at: Solution) -> FloatArray:
        """Return the drivers' values `(nq,)` of a solution."""
        quaternions = {j.name: Rotation.from_matrix(R).as_quat() for j, R in zip(self.mechanism.joints, at.R, strict=True)}
        values = []
        for c in self.mechanism.drivers:
            joint, _, axis = c.name.partition(".")
            values.append(quaternions[joint]["xyzw".index(axis[1])] if c.unit == "1" else at.s[self.equations.place[c.name]])
        return np.array(values)

    @property
    def freedoms(self) -> list[str]:
        """Names of the drivers' freedoms, in the order of the columns of a Jacobian."""
        names = [c.name for c in self.mechanism.drivers if c.unit != "1" or c.name.endswith(".qx")]
        return [one for name in names for one in ([f"{name[:-2]}r{axis}" for axis in "xyz"] if name.endswith(".qx") else [name])]

    def velocities(self, at: Solution) -> tuple[FloatArray, FloatArray]:
        """Return v of the parts' origins and ω per unit of each driver freedom, `(parts, 3, freedoms)`, as Jacobians state them."""
        found = self.equations.velocities(at, self.freedoms)
        for ball in self.balls:  # the equations turn a ball on its child's side, Jacobians in the parent connector's frame
            own = [self.freedoms.index(f"{ball.name}.r{axis}") for axis in "xyz"]
            for v in found:
                v[..., own] = v[..., own] @ at.R[self.mechanism.joints.index(ball)].T
        return found

    def _ways(self) -> Iterator[Way]:
        singles, freedoms = [c.name for c in self.mechanism.drivers if c.unit != "1"], self.freedoms
        goals: dict[str, float] = {}
        for c in self.mechanism.drivers:
            if c.unit != "1":
                at = self.equations.place[c.name]
                span = self.equations.L[at] * (self.rng.choice(SPANS) if c.unit == "rad" else 0.5) * self.rng.uniform(-1, 1)
                goals[c.name] = float(np.clip(self.equations.rest.s[at] + span, c.lower, c.upper))
        turns = {ball.name: Rotation.random(random_state=self.rng).as_matrix() for ball in self.balls}
        for name in singles:
            yield self._way((name,), self.equations.follow(freedoms, {name: goals[name]}))
        for name, R in turns.items():
            yield self._way((name,), self.equations.follow(freedoms, {}, {name: R}))
        if len(goals) + len(turns) > 1:
            yield self._way((*goals, *turns), self.equations.follow(freedoms, goals, turns))

    def _way(self, drivers: tuple[str, ...], found: list[Solution]) -> Way:
        """Keep what is within the limits of all joints, less a step, and of this a few samples."""
        bounded = [(self.equations.place[c.name], c) for c in self.mechanism.coordinates if c.unit != "1"]
        within = [all(c.lower - 1e-9 <= at.s[place] <= c.upper + 1e-9 for place, c in bounded) for at in found]
        inside = found[: within.index(False) if False in within else len(found)]
        kept = np.unique(np.linspace(0, len(inside) - 1, SAMPLES + 1).astype(int))[1:]
        return Way(drivers, [inside[k] for k in kept])


@lru_cache(maxsize=SOME)
def case_of(seed: int) -> Case:
    """Return the case of a seed; several tests ask for the same one."""
    return Case(seed)
