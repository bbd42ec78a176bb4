"""The true number of freedoms of a mechanism: the local dimension of the set of its closed configurations.

Grübler's count is wrong for every planar mechanism in space, so the constraints themselves decide. Their rank at rest gives the freedoms
to first order, which is an upper bound: it is too large where the rest pose is singular, and everywhere on a set whose equations have a
multiple root (a platform on eight parallel rods). A freedom counts only if the linkage can be moved along it by a finite amount:

1. At rest, move along a random combination of all first-order freedoms by ε and correct in the directions that the
   constraints determine. If the residual vanishes the set is a manifold of that dimension, because a random direction of a
   null space of dimension k is realised only if the set has dimension k (slicing, as in Bates, Hauenstein, Peterson,
   Sommese 2009).
2. Otherwise close from several such points with all freedoms. If they return to rest, the linkage is only shaky.
3. At each neighbour that stays away, repeat step 1. If it fails again the equations have a multiple root there: the
   displacements that survive closing span the tangent space, and their rank is the dimension.

Several sets may meet at rest, such as the translations and the screw of a platform on rods around a circle. Random directions may all
lead to the smaller one, so further ones are taken perpendicular to the secants of those. The mobility is the largest dimension that a
second point of the same set confirms.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.kinematics.factors import least_squares, right_singular, svd
from articad.kinematics.graph import JointGraph
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.layout import Layout
from articad.kinematics.loops import CLOSED, RANK_TOLERANCE, ClosureSystem

NEAR_SINGULAR = 1e-3  # σ/σ₁ between the rank tolerance and this is reported: drift, or a dead point nearby
REALISED = 1e-12  # |r| of a finite motion that the constraints allow; rounding gives 1e-15 · reach/L
NEARLY_FREE = 1e-3  # |r| below which an obstruction may be noise of the data; a true one of second order gives 2.5e-3 or more
_SLICE = 0.05  # rad, or lengths L: a finite motion; an obstruction of order m gives a residual of 0.05ᵐ
_SLICE_SHARE = 0.3  # of the smallest singular value: beyond it the linear model is not valid
_SHORTEST_SLICE = 2e-4  # a shorter one cannot distinguish an obstruction from rounding
_NEIGHBOURS, _ACROSS = 5, 3  # random neighbours of a singular rest pose, and those perpendicular to their secants
_SPANNED = 0.3  # σ/σ₁ of the secants: directions below it lead to no set found so far
_BESIDE = 0.05  # rad, or lengths L: their distance
_NEARER, _FARTHER = 0.005, 0.3  # for linkages that move by thousandths only; for obstructions of high order
_FAINT = 1e-8  # |r| of an obstruction at rest so small that it is of order four or more
_STUCK = 0.1  # share of the way to a neighbour: what closes nearer to rest has not moved
_AWAY = 0.3  # of the median of these ways: nearer to rest, sets that cross there are too close to tell apart; beyond its inverse lies another branch
_WITHIN = 0.2  # of that way: steps about a neighbour, short enough to stay on its set where others cross it at rest
_MULTIPLE = 1e-4  # σ/σ₁ at a neighbour; at a double root the solver stops 1e-6 away from it
_KEPT, _PATIENCE = 1e-9, 60  # σ/σ₁ that is corrected there, and steps
_SURVIVES, _ALL_SURVIVE = 0.3, 0.5  # share of a displacement that remains after closing, for a true motion; and where none is obstructed
_INDEPENDENT = 1e-5  # share of a driver's freedom that other drivers do not already give
_STILL = 1e-7  # rad, or lengths L per unit of motion: a part that moves less stands still


@dataclass(frozen=True, eq=False)
class Mobility:
    """The motions that the constraints leave.

    Attributes:
        mobility: Dimension of the set of closed configurations near the given one, for the joints that take part.
        first_order: Dimension of the null space of the constraints at the given configuration; never smaller.
        rank: Number of freedoms that the constraints determine.
        Q: A configuration in general position `(columns,)`; the given one if it is.
        freedoms: Orthonormal motions there `(freedoms, mobility)`, scaled.
        near: Smallest nonzero σ/σ₁ at the given configuration.
        obstruction: Least |r| after a small motion along the first-order freedoms; 0 if all are real.
        multiple: First-order freedoms at `Q` that are not motions: the equations have a multiple root there.
    """

    mobility: int
    first_order: int
    rank: int
    Q: FloatArray
    freedoms: FloatArray
    near: float
    obstruction: float = 0.0
    multiple: int = 0

    @property
    def shaky(self) -> bool:
        """True when the linkage moves to first order only: it is rigid, but barely."""
        return self.mobility == 0 < self.first_order


def mobility_of(system: ClosureSystem, Q: FloatArray) -> Mobility:
    """Return the mobility of a system at the closed configuration `Q`."""
    N, ratios = motions(system, Q)
    nonzero = ratios[ratios > RANK_TOLERANCE]
    near = float(nonzero.min()) if nonzero.size else 1.0
    first, n_active = N.shape[1], int(system.active.sum())
    rank = n_active - first
    regular = Mobility(first, first, rank, Q, N, near)
    if not first or rank == system.n_rows:  # independent constraints: the implicit function theorem
        return regular
    rng = np.random.default_rng(0)
    obstruction = _obstruction(system, Q, N, rank, rng)
    if obstruction <= REALISED:
        return regular
    found = _near(system, Q, N, obstruction, rng)
    best = _largest(system, found, first, rng) or _Neighbour(Q, N[:, :0], 0, 0.0)
    mobility = best.T.shape[1]
    return Mobility(mobility, first, n_active - mobility, best.Q, best.T, near, obstruction, best.multiple)


class Settled(NamedTuple):
    """The result of the correction along the well-determined directions.

    Attributes:
        Q: Coordinates `(columns,)`.
        residual: |r| there; the rest belongs to directions in which nothing was corrected.
        U: Left singular vectors `(rows, rows)` of the constraints in the active freedoms.
        s: Their singular values.
        Vt: Right singular vectors `(active, active)`.
        r: The residuals `(rows,)`.
    """

    Q: FloatArray
    residual: float
    U: FloatArray
    s: FloatArray
    Vt: FloatArray
    r: FloatArray


def settled(system: ClosureSystem, Q: FloatArray, rank: int | None, *, dropped: float = NEAR_SINGULAR, iterations: int = 12) -> Settled:
    """Correct Q by Gauss-Newton in the directions that the constraints determine, and leave the others unchanged.

    Args:
        system: The equations.
        Q: Start `(columns,)`.
        rank: How many directions to correct; None: those with σ/σ₁ above `dropped`, counted anew in each step.
        dropped: See `rank`.
        iterations: Steps at most.
    """
    where = np.flatnonzero(system.active)
    y, last = np.zeros(system.layout.n_freedoms), math.inf
    for k in itertools.count():
        r, J = system.evaluate_one(Q)
        U, s, Vt = svd(J[:, where], full=True)
        kept = rank if rank is not None else int((s > dropped * s.max(initial=0.0)).sum())
        step = -(Vt[:kept].T @ ((U[:, :kept].T @ r) / np.maximum(s[:kept], 1e-300)))
        size = float(np.abs(step).max(initial=0.0))
        if k >= iterations or size < 1e-15 or (size < 1e-9 and size >= 0.5 * last):
            break
        y[where] = step * min(1.0, 0.5 / size)
        Q, last = system.move(Q, y), size
    return Settled(Q, float(np.linalg.norm(r)), U, s, Vt, r)


def _obstruction(
    system: ClosureSystem, Q: FloatArray, N: FloatArray, rank: int, rng: np.random.Generator, longest: float = _SLICE
) -> float:
    """Return |r| after a finite motion along a random combination of N; inf if it leads elsewhere."""
    sigma = _smallest(system, Q, rank)
    size = max(_SHORTEST_SLICE, min(longest, _SLICE_SHARE * sigma))
    worst = 0.0
    for _ in range(2):
        c = rng.standard_normal(N.shape[1])
        predicted = system.move(Q, size * (N @ (c / np.linalg.norm(c))))
        there = settled(system, predicted, rank)
        if float(np.abs(system.step_between(predicted, there.Q)).max()) > 0.5 * size:
            return math.inf
        worst = max(worst, float(there.residual))
        if worst > REALISED:
            break
    return worst


def _smallest(system: ClosureSystem, Q: FloatArray, rank: int) -> float:
    """Return the smallest singular value that counts in the rank; the constraints are scaled, so it is dimensionless."""
    if not rank:
        return 1.0
    s, _ = right_singular(system.evaluate_one(Q)[1][:, np.flatnonzero(system.active)])
    return float(s[rank - 1])


class _Neighbour(NamedTuple):
    """A closed configuration near rest.

    Attributes:
        Q: Coordinates `(columns,)`.
        T: Tangent space `(freedoms, dimension)`.
        multiple: Null vectors of the constraints there that are not motions.
        size: Length of the steps [rad, or lengths L] with which T was found.
    """

    Q: FloatArray
    T: FloatArray
    multiple: int
    size: float


def _near(system: ClosureSystem, Q: FloatArray, N: FloatArray, obstruction: float, rng: np.random.Generator) -> list[_Neighbour]:
    """Return closed neighbours of a singular rest pose; none if every start returns to rest."""
    scales = (_FARTHER, _BESIDE, _NEARER) if obstruction < _FAINT else (_BESIDE, _NEARER)
    return next((found for scale in scales if (found := _neighbours(system, Q, N, scale, rng))), [])


def _neighbours(system: ClosureSystem, Q: FloatArray, N: FloatArray, scale: float, rng: np.random.Generator) -> list[_Neighbour]:
    """Return closed neighbours at a distance from rest: first in random directions, then perpendicular to the secants found so far."""
    reached, secants = list[FloatArray](), list[FloatArray]()
    basis, n = np.eye(N.shape[1]), _NEIGHBOURS
    while n and basis.size:
        for _ in range(n):
            c = basis @ rng.standard_normal(basis.shape[1])
            closed = _closed_beside(system, system.move(Q, scale * (N @ (c / np.linalg.norm(c)))))
            secant = system.step_between(Q, closed.Q)
            if closed.residual <= CLOSED and np.linalg.norm(secant) > _STUCK * scale:
                reached.append(closed.Q)
                secants.append(secant @ N)
        n = _ACROSS if secants and n == _NEIGHBOURS else 0
        if n:
            _, s, Vt = svd(np.array([secant / np.linalg.norm(secant) for secant in secants]), full=True)
            basis = Vt[int((s > _SPANNED * s[0]).sum()) :].T
    ways = np.array([np.linalg.norm(system.step_between(Q, there)) for there in reached])
    far = [(there, way) for there, way in zip(reached, ways, strict=True) if _AWAY < way / np.median(ways) < 1 / _AWAY]
    return [_tangent_space(system, there, _WITHIN * float(way), rng) for there, way in far]


def _largest(system: ClosureSystem, found: Sequence[_Neighbour], first: int, rng: np.random.Generator) -> _Neighbour | None:
    """Return a neighbour on a set of the largest dimension; None without neighbours.

    At a single point an obstruction of high order may be too small to detect. So the dimension counts if two neighbours have it, or if a
    step along the tangent space of the only one leads to a point that has it. A set with all `first` dimensions of the tangent space at
    rest would be smooth there, and the only one. So neighbours that have them do not count where others have fewer.
    """
    found = [one for one in found if one.T.shape[1] < first] or found
    dimensions = [one.T.shape[1] for one in found]
    for dimension in sorted(set(dimensions), reverse=True):
        one = found[dimensions.index(dimension)]
        if dimensions.count(dimension) > 1 or not dimension:
            return one
        c = rng.standard_normal(dimension)
        closed = _closed_beside(system, system.move(one.Q, one.size * (one.T @ (c / np.linalg.norm(c)))))
        if closed.residual <= CLOSED and _tangent_space(system, closed.Q, one.size, rng).T.shape[1] == dimension:
            return one
    return found[int(np.argmax(dimensions))] if found else None


def _closed_beside(system: ClosureSystem, Q: FloatArray) -> Settled:
    """Close from Q by plain Gauss-Newton: it halves the distance to a multiple root in each step, where damping would stall."""
    return settled(system, Q, None, dropped=_KEPT, iterations=_PATIENCE)


def _tangent_space(system: ClosureSystem, Q: FloatArray, scale: float, rng: np.random.Generator) -> _Neighbour:
    """Return the tangent space of the closed configurations at a point in general position, also at a multiple root."""
    N, _ = motions(system, Q, _MULTIPLE)
    k = N.shape[1]
    rank = int(system.active.sum()) - k
    if not k or rank == system.n_rows or _obstruction(system, Q, N, rank, rng, scale) <= REALISED:
        return _Neighbour(Q, N, 0, scale)
    tried, left = [], []
    for _ in range(k + 2):
        c = rng.standard_normal(k)
        c *= scale / float(np.linalg.norm(c))
        ends = [_closed_beside(system, system.move(Q, sign * (N @ c))) for sign in (1.0, -1.0)]
        if all(end.residual <= CLOSED for end in ends):  # the central difference has no error of second order
            tried.append(c)
            left.append(0.5 * system.step_between(ends[1].Q, ends[0].Q) @ N)
    if len(tried) < k:
        return _Neighbour(Q, N[:, :0], k, scale)
    projection = least_squares(
        np.array(tried), np.array(left), RANK_TOLERANCE
    )  # maps c to what remains of it: 1 on the tangent space, else 0
    _, s, Vt = svd(projection, full=True)
    dimension = _surviving(s)
    return _Neighbour(Q, N @ Vt[:dimension].T, k - dimension, scale)


def _surviving(s: FloatArray) -> int:
    """Return how many of the displacements with these shares `(k,)`, the largest first, are motions.

    Closing at a multiple root takes back an obstructed displacement to a hundredth or less, and may also shorten a true one. So the widest
    gap between the shares decides. All are motions only if all remain: the first of them met an obstruction.
    """
    if s[-1] > _ALL_SURVIVE or s[0] <= _SURVIVES:
        return len(s) if s[-1] > _ALL_SURVIVE else 0
    return 1 + int(np.argmax(s[:-1] / np.maximum(s[1:], 1e-300))) if len(s) > 1 else 1


def motions(system: ClosureSystem, Q: FloatArray, tolerance: float = RANK_TOLERANCE) -> tuple[FloatArray, FloatArray]:
    """Return the null space `(freedoms, n)` of the constraints at Q among the active freedoms, and all σ/σ₁.

    Args:
        system: The equations.
        Q: Coordinates `(columns,)`.
        tolerance: σ/σ₁ below which a constraint does not count.
    """
    where = np.flatnonzero(system.active)
    J = system.evaluate_one(Q)[1][:, where]
    if not J.size:
        return np.zeros((system.layout.n_freedoms, 0)), np.zeros(0)
    s, Vt = right_singular(J)
    ratios = s / s[0]
    rank = int((ratios > tolerance).sum())
    N = np.zeros((system.layout.n_freedoms, len(where) - rank))
    N[where] = Vt[rank:].T
    return N, ratios


def choose_drivers(system: ClosureSystem, freedoms: FloatArray) -> tuple[tuple[int, ...], tuple[Joint, ...]]:
    """Choose the driving coordinates: those of marked joints first, then the others, each if it is independent of those chosen.

    Args:
        system: The equations.
        freedoms: Motions that the constraints leave `(freedoms of the system, mobility)`.

    Returns:
        Columns of the system in the order in which they are declared, and the marked joints that cannot drive.
    """
    # greedy choice of independent rows of the motions: a coordinate drives if its row is not in the span of those before it
    basis: list[FloatArray] = []
    chosen: list[int] = []
    refused: list[Joint] = []
    layout = system.layout
    for joint in sorted(layout.joints, key=lambda joint: not joint.driver):
        columns, own = layout.columns[joint.name], layout.freedoms[joint.name]
        rows = list(freedoms[own])
        taken, plain = 0, len(rows) if joint.type.quaternion is None else joint.type.quaternion
        if plain < len(rows):  # a quaternion drives as a whole, or not at all
            grown = _extended(basis, rows[plain:])
            if len(grown) == len(basis) + 3:
                basis, taken = grown, 3
                chosen.extend(range(columns.start + plain, columns.stop))
            elif joint.driver:
                refused.append(joint)
                continue
        for offset, row in enumerate(rows[:plain]):
            grown = _extended(basis, [row])
            if len(grown) > len(basis):
                basis, taken = grown, taken + 1
                chosen.append(columns.start + offset)
        if joint.driver and not taken and system.active[own].all():
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
    """Return parts, or pairs of parts that a joint connects, which can move while everything else stands still."""
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
        still = null_space(moved[outside].reshape(-1, moved.shape[2]))
        if still.shape[1] and np.abs(moved[inside] @ still).max() > _STILL and len(outside) > 1:
            found.append(group)
    return tuple(found)


def null_space(A: FloatArray) -> FloatArray:
    """Return orthonormal vectors `(n, k)` that `A` `(m, n)` takes to 0."""
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
        loop: Parts of the loop.
        joint: The joint that closes it; the directions are in the frame of its connector.
        count: How many constraints are redundant.
        directions: Which ones, such as "turning about x".
        release: Joint names and the types that would free the loop without adding a motion; empty if there are none.
    """

    loop: tuple[str, ...]
    joint: str
    count: int
    directions: tuple[str, ...]
    release: tuple[tuple[str, JointType], ...]


def redundancies(
    parts: Sequence[str], ground: str, layout: Layout, system: ClosureSystem, mobility: Mobility, Q_all: FloatArray, *, release: bool = True
) -> tuple[Redundancy, ...]:
    """Return the redundant constraints of each loop (null space of Jᵀ) and the joints to release so that real, inexact parts fit."""
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
    """Return how many constraints are redundant and how many freedoms remain, to first order at rest."""
    tree, loop_joints = JointGraph(parts, ground, joints).spanning_tree()
    system = ClosureSystem(tree, Layout(joints), loop_joints, couplings)
    N, _ = motions(system, system.layout.rest)
    rank = int(system.active.sum()) - N.shape[1]
    return system.n_rows - rank, N.shape[1]
