"""Freedoms that a mechanism really has: rank of the constraints, not a count of joints.

Grübler's count is wrong for every planar mechanism in space, so the rank of the scaled Jacobian decides. A single
configuration may be singular; the mobility is the smallest of several neighbours on the linkage's own motion.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from articad.connectors import FloatArray
from articad.kinematics.factors import right_singular, svd
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.loops import RANK_TOLERANCE, ClosureSystem

NEAR_SINGULAR = 1e-3  # σ/σ₁ between the rank tolerance and this is reported: drift, or a dead point nearby
_TRIES = 10
_PERTURBATION = 0.3  # rad, or lengths L: along the freedoms, far enough to leave a singular configuration
_STUCK = 1e-2  # rad, or lengths L: a perturbed configuration that closes nearer than this has not moved
_INDEPENDENT = 1e-5  # share of a driver's freedom that others do not give already
_STILL = 1e-7  # rad, or lengths L per unit of motion: a part that moves less stands still


@dataclass(frozen=True, eq=False)
class Mobility:
    """What the constraints leave free.

    Attributes:
        mobility: Freedoms of the joints that take part, in general position.
        first_order: The same at the given configuration; larger when that is singular.
        rank: Of the constraints, in general position.
        Q: A configuration in general position `(columns,)`; the given one where that is.
        freedoms: Orthonormal motions there `(freedoms, mobility)`, scaled.
        near: Smallest nonzero σ/σ₁ at the given configuration.
    """

    mobility: int
    first_order: int
    rank: int
    Q: FloatArray
    freedoms: FloatArray
    near: float

    @property
    def shaky(self) -> bool:
        """True when the linkage moves to first order only: it is rigid, but barely."""
        return self.mobility == 0 < self.first_order


def mobility_of(system: ClosureSystem, Q: FloatArray) -> Mobility:
    """Return the mobility of a system, judged at the closed configuration `Q` and at neighbours of it."""
    N, ratios = motions(system, Q)
    nonzero = ratios[ratios > RANK_TOLERANCE]
    first = N.shape[1]
    best, at = N, Q
    rng = np.random.default_rng(0)
    stuck = moved = 0
    for _ in range(_TRIES if first else 0):
        closed = system.close(system.move(Q, _PERTURBATION * (N @ rng.standard_normal(first))), system.active)
        if not closed.ok:
            continue
        if np.abs(system.step_between(Q, closed.Q)).max() < _STUCK:
            stuck += 1
            continue
        moved += 1
        there, _ = motions(system, closed.Q)
        if there.shape[1] < best.shape[1]:
            best, at = there, closed.Q
        if best.shape[1] == 1:  # it moved, so it has a freedom, and no more than one
            break
    if stuck and not moved:  # every try fell back to where it began: it moves to first order only
        best, at = N[:, :0], Q
    n_active = int(system.active.sum())
    near = float(nonzero.min()) if nonzero.size else 1.0
    return Mobility(best.shape[1], first, n_active - best.shape[1], at, best, near)


def motions(system: ClosureSystem, Q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the null space `(freedoms, n)` of the constraints at Q among the active freedoms, and all σ/σ₁."""
    where = np.flatnonzero(system.active)
    J = system.evaluate_one(Q)[1][:, where]
    if not J.size:
        return np.zeros((system.layout.n_freedoms, 0)), np.zeros(0)
    s, Vt = right_singular(J)
    ratios = s / s[0]
    rank = int((ratios > RANK_TOLERANCE).sum())
    N = np.zeros((system.layout.n_freedoms, len(where) - rank))
    N[where] = Vt[rank:].T
    return N, ratios


def choose_drivers(layout: Layout, system: ClosureSystem, freedoms: FloatArray) -> tuple[tuple[int, ...], tuple[Joint, ...]]:
    """Choose which columns drive: those of marked joints first, then the others, each if it is independent of the chosen.

    Args:
        layout: Of all joints of the mechanism.
        system: The equations.
        freedoms: Motions that the constraints leave `(freedoms of the system, mobility)`.

    Returns:
        Columns of all joints in order of declaration, and the marked joints that cannot drive.
    """
    basis: list[FloatArray] = []
    chosen: list[int] = []
    refused: list[Joint] = []
    for joint in sorted(layout.joints, key=lambda joint: not joint.driver):
        columns = layout.columns[joint.name]
        if joint.name not in system.layout.columns or not system.active[system.layout.freedoms[joint.name]].any():
            chosen.extend(range(columns.start, columns.stop))
            continue
        rows = list(freedoms[system.layout.freedoms[joint.name]])
        if joint.type is JointType.BALL:
            grown = _extended(basis, rows)
            if len(grown) == len(basis) + 3:
                basis = grown
                chosen.extend(range(columns.start, columns.stop))
            elif joint.driver:
                refused.append(joint)
            continue
        taken = 0
        for offset, row in enumerate(rows):
            grown = _extended(basis, [row])
            if len(grown) > len(basis):
                basis, taken = grown, taken + 1
                chosen.append(columns.start + offset)
        if joint.driver and not taken:
            refused.append(joint)
    return tuple(sorted(chosen)), tuple(refused)


def _extended(basis: Sequence[FloatArray], rows: Sequence[FloatArray]) -> list[FloatArray]:
    """Return an orthonormal basis of the span of both; rows that add less than 1e-5 are left out."""
    grown = list(basis)
    for row in rows:
        left = row
        for b in itertools.chain(grown, grown):  # twice is enough (Giraud, Langou, Rozložník)
            left = left - (left @ b) * b
        size = float(np.linalg.norm(left))
        if size > _INDEPENDENT:
            grown.append(left / size)
    return grown


def idle_parts(system: ClosureSystem, mobility: Mobility) -> tuple[tuple[str, ...], ...]:
    """Return parts, or pairs that a joint connects, which can move while everything else stands still."""
    arrays = system.arrays
    if not mobility.mobility:
        return ()
    names = list(system.parts)
    T = arrays.matrices(mobility.Q[None])
    v0, omega = arrays.twists(T, mobility.Q[None])
    V = np.concatenate([v0[:, 0] / system.length, omega[:, 0]], axis=1) * system.scale[:, None]  # (freedoms, 6)
    moved = np.einsum("pf,fk,fm->pkm", arrays.carried, V, mobility.freedoms)  # (parts, 6, mobility)
    pairs = [tuple(sorted((joint.parent, joint.child))) for joint in system.layout.joints]
    found: list[tuple[str, ...]] = []
    for group in [*((name,) for name in names), *dict.fromkeys(pairs)]:
        if any(set(known) & set(group) for known in found):
            continue
        inside = [names.index(name) for name in group]
        outside = [i for i in range(len(names)) if i not in inside]
        still = _null_space(moved[outside].reshape(-1, moved.shape[2]))
        if still.shape[1] and np.abs(moved[inside] @ still).max() > _STILL and len(outside) > 1:
            found.append(group)
    return tuple(found)


def _null_space(A: FloatArray) -> FloatArray:
    s, Vt = right_singular(A)
    rank = int((s > _STILL * max(1.0, float(s[0]) if s.size else 1.0)).sum())
    null: FloatArray = Vt[rank:].T
    return null


# --- overconstraint

_ROWS = ("sliding along x", "sliding along y", "sliding along z", "turning about x", "turning about y", "turning about z")


@dataclass(frozen=True)
class Redundancy:
    """Constraints of a loop that the others imply: real parts would have to be exact to fit.

    Attributes:
        loop: Parts round the loop.
        joint: The joint that closes it, in whose connector's frame the directions are.
        count: How many constraints are redundant.
        directions: Which ones, such as "turning about x".
        release: Joint names and the types that would free the loop without another motion; empty if there is no such way.
    """

    loop: tuple[str, ...]
    joint: str
    count: int
    directions: tuple[str, ...]
    release: tuple[tuple[str, JointType], ...]


def redundancies(
    parts: Sequence[str], ground: str, layout: Layout, system: ClosureSystem, mobility: Mobility, Q_all: FloatArray, *, release: bool = True
) -> tuple[Redundancy, ...]:
    """Return the redundant constraints of each loop (null space of Jᵀ) and the joints to release for real-life tolerance."""
    where = np.flatnonzero(system.active)
    J = system.evaluate_one(mobility.Q)[1][:, where]
    Z = _null_space_of_transpose(J, mobility.rank)
    if not Z.shape[1]:
        return ()
    releases = _releases(parts, ground, layout, system, mobility, Q_all) if release else {}
    found = []
    for i, loop in enumerate(system.loops):
        share = (Z[6 * i : 6 * i + 6] ** 2).sum(axis=1)
        count = round(float(share.sum()))
        if count:
            strongest = sorted(np.argsort(-share, kind="stable")[:count])
            names = {joint.name for joint in loop.joints}
            freed = tuple((name, new) for name, new in releases.items() if name in names)
            found.append(Redundancy(loop.parts, loop.joint.name, count, tuple(_ROWS[k] for k in strongest), freed))
            releases = {name: new for name, new in releases.items() if name not in names}
    return tuple(found)


def _null_space_of_transpose(J: FloatArray, rank: int) -> FloatArray:
    U, _, _ = svd(J, full=True)
    null: FloatArray = U[:, rank:]
    return null


def _releases(
    parts: Sequence[str], ground: str, layout: Layout, system: ClosureSystem, mobility: Mobility, Q_all: FloatArray
) -> dict[str, JointType]:
    """Choose greedily which joints become balls or cylindrical, such that redundancy falls and mobility stays."""
    values = {joint.name: Q_all[layout.columns[joint.name]] for joint in layout.joints}
    joints = {joint.name: replace(joint, rest=tuple(float(v) for v in values[joint.name])) for joint in layout.joints}
    coupled = {name.split(".")[0] for c in system.couplings for name in (c.a, c.b)}
    redundant = system.n_rows - mobility.rank
    chosen: dict[str, JointType] = {}
    for loop in system.loops:
        for added in (2, 1):
            for joint in reversed(loop.joints):
                if joint.driver or joint.name in coupled or joint.name in chosen or not redundant:
                    continue
                freed = _freed(joints[joint.name], added)
                if freed is None or redundant < added:
                    continue
                trial = {**joints, joint.name: freed}
                if _redundancy(parts, ground, tuple(trial.values()), system.couplings) == (redundant - added, mobility.first_order):
                    joints, redundant, chosen[joint.name] = trial, redundant - added, freed.type
                    break
    return chosen


def _freed(joint: Joint, added: int) -> Joint | None:
    """Return the joint with `added` more freedoms and the same motion at rest, or None."""
    endless = (-math.inf, math.inf)
    if joint.type is JointType.REVOLUTE and added == 2:
        half = 0.5 * joint.rest[0]
        return replace(joint, type=JointType.BALL, limits=JointLimits(), rest=(0.0, 0.0, math.sin(half), math.cos(half)))
    if joint.type in {JointType.REVOLUTE, JointType.SLIDER} and added == 1:
        rest = (0.0, joint.rest[0]) if joint.type is JointType.REVOLUTE else (joint.rest[0], 0.0)
        return replace(joint, type=JointType.CYLINDRICAL, limits=JointLimits(endless[:1] * 2, endless[1:] * 2), rest=rest)
    return None


def _redundancy(parts: Sequence[str], ground: str, joints: Sequence[Joint], couplings: Sequence[Coupling]) -> tuple[int, int]:
    """Return how many constraints are redundant and how many freedoms are left, to first order at rest."""
    tree, loop_joints = JointGraph(parts, ground, joints).spanning_tree()
    system = ClosureSystem(tree, Layout(joints), loop_joints, couplings)
    N, _ = motions(system, system.layout.rest)
    rank = int(system.active.sum()) - N.shape[1]
    return system.n_rows - rank, N.shape[1]
