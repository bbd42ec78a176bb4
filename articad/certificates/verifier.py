"""Check a motion certificate without trusting it: the checker behind `articad verify-certificate`.

The checker is independent of the prover and uses NumPy alone; `verifier_files.py` and `verifier_tolerance.py` are parts of it. A certificate claims that parts stay apart while joints move within
ranges. A proof file says how to cut surfaces and ranges, and which direction separates each two pieces. The checker trusts none of it
and searches for nothing. It computes every inequality again from meshes and joints, and refutes a proof that omits a piece, a range or a
pair. The parts of the check:

- `verifier_files`: the files are read within bounds of size and memory.
- `Checker.check_joints`: the mechanism is well formed, and joints of loops and couplings are declared as such.
- `Checker.closure`, `enclosures`, `held`, `join`: followers of drivers have one solution in a tube about a quadratic curve.
- `Checker.prove`, `boxes`, `follow`, `apart`, `motion`: each two pieces of surface are further apart than the motion can bring them.
- `Checker.check_complete`, `missing`, `is_repeated`: every pair of parts has a claim over every range for which it needs one.
- `verifier_tolerance.Tolerance`: where claims are to hold within tolerance, they keep the shares of both parts, or say what rules instead.
"""

from __future__ import annotations

import functools
import hashlib
import itertools
import json
import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from articad.certificates.verifier_files import Refuted, arrays_in, need, text
from articad.certificates.verifier_tolerance import Tolerance

PROOF = "_proof"  # no part has this name
ROUNDING = 1e-9  # of ranges, distances, and what a driver moves
HALF = 0.5  # largest deviation of entries of a rotation by which a loop may be open: it excludes half a turn, even with 1 rad more
SIDES = np.array(list(itertools.product((0, 1), repeat=3)))
COURSE = ("uses", "parts_a", "parts_b", "about", "cuts", "at", "codes", "along", "of_a")  # arrays of every claim
REST = 1e-6  # rad or mm: largest deviation of a follower at rest
STIFF = 1e-4  # rad or mm: radius about the rest pose of joints without a driver, within which there is no other solution
SETTLED = 1e-7  # rad or mm: precision of a solution at the ends of a range that repeats
FLOAT = 1e-12  # tolerance for a ratio to fit whole turns
BULK = 512  # rows processed together
TUBES = 16  # pieces of drivers' ranges processed together
NODES = np.array([-1.0, -(0.5**0.5), 0.0, 0.5**0.5, 1.0])  # of quartic interpolation: the extrema of the Chebyshev polynomial T4, whose ...
LEBESGUE, QUINTIC = 1.8, 1 / 960  # ... Lebesgue constant is below 1.8, and whose error is below 1/960 of the largest fifth derivative
# from values at the nodes to Bernstein coefficients
BERNSTEIN = np.linalg.inv([[math.comb(4, j) * (1 + t) ** j * (1 - t) ** (4 - j) / 16 for j in range(5)] for t in NODES])
LARGEST = 1e7  # mm or rad: beyond it, rounding of numbers matters
SWUNG = -7  # a piece stays inside a cone about a ball's axis however it swings, and the other one outside
LEAN, ROUND, OUTSIDE = -6, -5, -4  # pieces differ in angle from a ball's axis, or in radius; a box lies outside the cone of a ball
BESIDE = np.radians([0, *(sign * 2.0**k for sign in (-1, 1) for k in range(-1, 6))])  # of the cones that keep a swing apart
CUT = -3  # and -2, -1: the piece of a, of b, or the box is cut


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return the reasons why a certificate file is refuted, an empty list if it is accepted.

    Files larger than a bound are neither: the reason then begins with `UNREAD`. Memory is bounded whatever the files hold.

    Args:
        file: The certificate.
        folder: Directory with `<part>.npz` for every part, and the proof.
    """
    try:
        certificate = json.loads(text(file))
        arrays = arrays_in(folder, [*certificate["meshes"], PROOF])
        left = sorted({found.stem for found in folder.glob("*.npz")} - set(arrays))
        need(not left, f"it omits {', '.join(left)}")
        Checker(certificate, arrays).check()
    except Refuted as reason:
        return [str(reason)]
    except Exception as error:  # noqa: BLE001 - a certificate that breaks its checker in any way proves nothing
        return [f"it cannot be read: {error!r}"[:500]]
    return []


def digest(vertices: Any, triangles: Any) -> str:
    """Return the hash of a mesh as a certificate stores it."""
    v, f = np.ascontiguousarray(vertices, "<f8"), np.ascontiguousarray(triangles, "<i4")
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


def shells(V: Any, F: Any) -> Any:
    """Return one vertex index of each connected component of a closed mesh; refute an open mesh."""
    need(V.shape[1:] == F.shape[1:] == (3,) and np.abs(V).max() < LARGEST, "a mesh is not valid")
    label = np.arange(len(V))
    forth, back = (np.sort((F * len(V) + np.roll(F, step, 1)).ravel()) for step in (1, -1))  # edges, by their two ends
    need(np.array_equal(forth, back), "a mesh is open")
    while (label[F] != (least := label[F].min(1, keepdims=True))).any():
        np.minimum.at(label, F, least)
        label = label[label]
    return np.unique(label[F])


def is_inside(points: Any, vertices: Any, triangles: Any) -> bool:
    """Return whether a closed surface encloses any of the points: its solid angle there is not 0 (van Oosterom and Strackee, 1983)."""
    low, high = vertices.min(0), vertices.max(0)
    for point in points[((low <= points) & (points <= high)).all(1)]:  # outside its bounding box the angle is 0
        a, b, c = (vertices[column] - point for column in triangles.T)
        la, lb, lc = (np.sqrt(dot(v, v)) for v in (a, b, c))
        below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
        if abs(np.arctan2(dot(a, cross(b, c)), below).sum()) > np.pi:  # half of the winding about a point inside
            return True
    return False


def ordered(corners: Any, order: Any) -> Any:
    """Return the triangles in another order; refute an order that is not a permutation."""
    need(np.array_equal(np.sort(order), np.arange(len(corners))), "a triangle is missing")
    return corners[order]


def plane(axis: Any) -> Any:
    """Return the projection perpendicular to a unit axis."""
    return np.eye(3) - np.outer(axis, axis)


class Hulls:
    """Points whose hulls contain pieces of a surface `(n, 3, 3)`: the corners of one or two triangles, or of the box of more."""

    def __init__(self, corners: Any) -> None:
        self.points, count = corners.reshape(-1, 3), len(corners)
        ends = (functools.reduce(of, np.moveaxis(corners, 1, 0)) for of in (np.minimum, np.maximum))
        self.ends = [np.append(end, corners[:1, 0], axis=0) for end in ends]  # with a row after the last
        self.base, self.known, self.found = count + 1, np.empty(0, dtype=np.int64), np.empty((0, 8, 3))

    def of(self, spans: Any) -> Any:
        """Return where `found` has the points `(8, 3)` of pieces, each from one triangle of the order up to another `(k, 2)`."""
        keys = spans @ [self.base, 1]
        new = np.setdiff1d(keys, self.known)
        if len(new):
            starts, stops = np.divmod(new, self.base)
            box = np.stack(
                [
                    of.reduceat(ends, np.stack([starts, stops], axis=1).ravel())[::2]
                    for of, ends in zip((np.minimum, np.maximum), self.ends, strict=True)
                ]
            )
            found, few = np.moveaxis(box, 0, 1)[:, SIDES, [0, 1, 2]], stops - starts <= 2
            which = 3 * starts[few, None] + np.arange(8) % (3 * np.maximum(stops - starts, 1)[few, None])
            found[few] = self.points[which]
            order = np.argsort(known := np.append(self.known, new))
            self.known, self.found = known[order], np.append(self.found, found, axis=0)[order]
        return np.searchsorted(self.known, keys)


def radii(flat: Any) -> tuple[Any, Any]:
    """Return the least and largest distance of triangles `(n, 3, 3)` from 0."""
    edge = flat[:, [1, 2, 0]] - flat
    n, along = cross(edge[:, 0], edge[:, 1]), -dot(flat, edge) / np.maximum(dot(edge, edge), 1e-300)
    nearest = flat + np.clip(along, 0, 1)[..., None] * edge
    least = np.sqrt(functools.reduce(np.minimum, dot(nearest, nearest).T))
    over = functools.reduce(np.minimum, dot(cross(n[:, None], edge), -flat).T) > 0  # 0 lies above the triangle, or below it
    size, longest = np.sqrt(dot(n, n)), np.sqrt(functools.reduce(np.maximum, dot(edge, edge).T))
    # Seen along it, a wall is a line, and rounding decides what lies above it: but no point is farther from its edges than it is high.
    height = np.maximum(np.abs(dot(n, flat[:, 0])) / np.maximum(size, 1e-300), least - size / np.maximum(longest, 1e-300))
    return np.where(over, np.minimum(least, height), least), np.sqrt(functools.reduce(np.maximum, dot(flat, flat).T))


def leans(local: Any, axis: Any) -> tuple[Any, Any]:
    """Return the smallest and largest angle of triangles `(n, 3, 3)` from an axis through 0."""
    height, wide = local @ axis, radii(local @ plane(axis))
    ends = np.arctan2(wide, height.max(1)), np.arctan2(wide, height.min(1))
    return ends[0].min(0), ends[1].max(0)


def apart(u: Any, p: Any, q: Any, moving: Any) -> Any:
    """Return the gap `(k,)` along directions `(k, 3)` between points `(k, n, 3)` of both parts, minus the bound of the motion of q [mm]."""
    R, t, *rest = moving
    there = q @ R.swapaxes(1, 2) + t[:, None]
    ahead = (there @ u[..., None])[..., 0] - motion(u, there, *rest)
    return ahead.min(1) - (p @ u[..., None])[..., 0].max(1)


def follow(rows: Any, codes: Any, directions: Any, A: Any, B: Any, how: Any, clear: float) -> None:
    """Repeat the cuts of the proof, level by level, and check that the pieces of each row that is not cut are further apart than `clear`.

    A row `(5,)` holds the first and last triangle of a piece of a, those of a piece of b, and the number of a box.
    """
    (along, of_a), (moving, halves, kept), hulls, level = directions, how, (Hulls(A), Hulls(B)), rows
    while len(level):
        told, codes = codes[: len(level)], codes[len(level) :]
        need(len(told) == len(level), "rows are missing")
        for (*row, box), code in zip(level[told < CUT].tolist(), told[told < CUT].tolist(), strict=True):
            need(kept(code, slice(*row[:2]), slice(*row[2:]), box) > clear, "pieces come too close")
        settled, by = level[told >= 0], told[told >= 0]
        at = [hull.of(settled[:, columns]) for hull, columns in zip(hulls, (slice(2), slice(2, 4)), strict=True)]
        for start in range(0, len(settled), BULK):
            rows = slice(start, start + BULK)
            some, code = settled[rows], by[rows]
            box = some[:, 4]
            u = np.where((code < of_a)[:, None], along[code], (moving[0][box] @ along[code][..., None])[..., 0])
            p, q = (hull.found[places[rows]] for hull, places in zip(hulls, at, strict=True))
            for k in np.flatnonzero(~(apart(u, p, q, [part[box] for part in moving]) > clear)).tolist():
                one, x, y = slice(k, k + 1), slice(*some[k, :2]), slice(*some[k, 2:4])  # all corners give more than those of the box
                gap = apart(u[one], A[x].reshape(1, -1, 3), B[y].reshape(1, -1, 3), [part[box[one]] for part in moving])
                need(gap[0] > clear, "pieces come too close")
        is_cut = (told >= CUT) & (told < 0)
        kind, level = np.repeat(told[is_cut], 2), np.repeat(level[is_cut], 2, axis=0)
        second = np.arange(len(level)) % 2
        for column, code in ((0, CUT), (2, CUT + 1)):
            middle = (level[:, column] + level[:, column + 1]) // 2
            for end in (0, 1):
                which = (kind == code) & (second != end)
                level[which, column + end] = middle[which]
        which = kind == CUT + 2
        level[which, 4] = halves[level[which, 4], second[which]]
        need((level >= 0).all(), "a box is not halved")


def dot(a: Any, b: Any) -> Any:
    """Return the inner products of vectors `(..., 3)`."""
    return np.einsum("...i,...i->...", a, b)


def cross(a: Any, b: Any) -> Any:
    """Return the cross products of vectors `(..., 3)`."""
    return a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]]


def length(v: Any) -> Any:
    """Return the lengths of vectors `(..., 3)`: a sum over so short an axis is slower by far."""
    return np.sqrt(v[..., 0] * v[..., 0] + v[..., 1] * v[..., 1] + v[..., 2] * v[..., 2])


def spins(axes: Any) -> Any:
    """Return 4 x 4 matrices K with K @ (p, 1) = (axis x p, 0)."""
    found = np.zeros((*axes.shape[:-1], 4, 4))
    found[..., :3, :3] = np.cross(axes[..., None, :], np.eye(3)).swapaxes(-1, -2)
    return found


def framed(parent: Any, child: Any) -> Any:
    """Return the transforms before and after the motion of a joint, crossed from its parent and from its child."""
    before, after = np.array(parent), np.linalg.inv(child)
    return (before, after), (np.linalg.inv(after), np.linalg.inv(before))


def boxed(ends: Any) -> tuple[tuple[float, float], ...]:
    """Return ranges `(drivers, 2)` in a form that can be a key."""
    return tuple((low, high) for low, high in ends.tolist())


def swung(local: Any, axis: Any, cone: float) -> Any:
    """Return how far triangles `(n, 3, 3)` are outside cones about an axis through 0: at least at rest, at most while they swing.

    That is r cos c - z sin c, which changes by no more than a point moves; a swing adds at most its angle to that from the axis.
    """
    flat, far, found = local @ plane(axis), np.linalg.norm(local, axis=2), []
    r, mean, narrow = np.linalg.norm(flat, axis=2), flat.mean(1, keepdims=True), radii(flat)[0]
    along = (flat * mean).sum(2) / np.maximum(np.linalg.norm(mean, axis=2), 1e-300)  # no more than the radius
    for z, c in itertools.product((local @ axis, -local @ axis), np.clip(cone + BESIDE, 0, np.pi / 2)):
        d, ahead = c - cone, (z >= 0).all(1, keepdims=True)
        most = np.where((z * np.cos(d) + r * np.sin(d) >= 0) & ahead, r * np.cos(d) - z * np.sin(d), far)
        least = np.maximum((along * np.cos(c) - z * np.sin(c)).min(1), narrow * np.cos(c) - z.max(1) * np.sin(c))
        found.append([least, most.max(1)])
    return np.moveaxis(np.array(found), 0, 2)


def joined(ends: Any, rows: list[Any]) -> tuple[Any, Any, Any]:
    """Return the union of pieces of drivers' ranges: value and rates of a linear function over all, and the largest distance from it.

    Ends are (k, drivers, 2); a row is a value (n,), rates (drivers, n) and a distance (n,).
    """
    if len(rows) == 1:
        return tuple(rows[0])
    (value, rates, near), signs = (np.array(column) for column in zip(*rows, strict=True)), corners_of(ends.shape[1])
    steps = signs * (ends[..., 1] - ends[..., 0])[:, None] / 2  # from the middle of each piece to its corners
    at = value[:, None] + steps @ rates
    places = ends.mean(2)[:, None] + steps - (ends.min((0, 2)) + ends.max((0, 2))) / 2
    design = np.concatenate([np.ones((*places.shape[:2], 1)), places], axis=2).reshape(-1, 1 + ends.shape[1])
    middle, *slopes = np.linalg.lstsq(design, at.reshape(len(design), -1), rcond=None)[0]
    off = at - middle - places @ np.array(slopes)  # linear on each piece, so the corners decide
    low, high = (off - near[:, None]).min((0, 1)), (off + near[:, None]).max((0, 1))
    return middle + (low + high) / 2, np.array(slopes), (high - low) / 2 + ROUNDING**2


def corners_of(count: int, places: Any = (-1, 1)) -> Any:
    """Return all combinations of places on each of so many axes, `(places^count, count)`."""
    return np.array(list(itertools.product(places, repeat=count)), dtype=float)


def on_path(row: Any, at: Any) -> Any:
    """Return the centre of a piece's tube at values of the drivers `(drivers,)`: linear and quadratic terms about the middle."""
    ends, _, rates, _, (guess, curve, *_) = row
    step = at - ends.mean(1)
    return guess + step @ rates + step @ np.tensordot(step, curve, 1) / 2


def is_outside(ball: dict[str, Any], box: dict[str, tuple[float, float]]) -> bool:
    """Return whether a box lies outside the cone of a ball: turns x and y swing it by acos(cos x · cos y)."""
    x, y = (max(box[f["name"]][0], -box[f["name"]][1], 0.0) for f in ball["freedoms"][:2])
    return max(x, y) < math.pi / 2 and math.cos(x) * math.cos(y) < math.cos(ball["cone"]) - ROUNDING


def motion(u: Any, p: Any, spins: Any, v: Any, along: Any, aside: Any, turned: Any, outer: Any) -> Any:
    """Bound how far points `(k, n, 3)` move along directions `(k, 3)` while factors move `along` drivers together and `aside` each.

    That is their speed, plus half the second derivative: along u the factor i outside j turns what j moves by |u x axis i|.
    `spins (k, F, 3, 3)`, `v (k, F, 3)`, `along (k, F, drivers)`, the others `(k, F)`; returns `(k, n)`.
    """
    all_spins = spins.reshape(len(u), -1, 3)  # one product for all factors; p @ spin is axis x p, and p @ spin' is -axis x p
    across, width, turns = (all_spins @ u[..., None]).reshape(v.shape), np.abs(along).sum(2) + aside, turned > 0
    speeds = p @ across.swapaxes(1, 2) + (v @ u[..., None]).swapaxes(1, 2)
    reach = length(v[:, None] - (p @ all_spins.swapaxes(1, 2)).reshape(*p.shape[:2], *v.shape[1:]))
    moved, inside = np.abs(speeds @ along).sum(2) + (np.abs(speeds) @ aside[..., None])[..., 0], np.zeros(p.shape[:2])
    tilt = np.minimum(length(across) + outer, 1.0) * turned
    share = np.cumsum(tilt, axis=1) - tilt / 2
    for f in reversed(range(tilt.shape[1])):
        carried = width[:, f, None] * (reach[..., f] + inside * turns[:, f, None])
        moved, inside = moved + carried * share[:, f, None], inside + carried
    return moved


def grouped_by(rows: Iterable[Any], key: Callable[[Any], Any]) -> dict[Any, list[Any]]:
    """Return rows by what they are about: a search of all rows for each pair would take work that grows as the square of their number."""
    groups: dict[Any, list[Any]] = {}
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


class Checker:
    """Checks a certificate with its meshes and its proof."""

    def __init__(self, certificate: dict[str, Any], arrays: dict[str, dict[str, Any]]) -> None:
        self.certificate, self.meshes, self.proof = certificate, arrays, arrays[PROOF]
        self.joints, self.drivers = {joint["name"]: joint for joint in certificate["mechanism"]["joints"]}, list(certificate["drivers"])
        self.freedoms = {f["name"]: f for joint in self.joints.values() for f in joint["freedoms"]}
        self.tolerance = Tolerance(certificate)
        self.fixed = {name for name, joint in self.joints.items() if not joint["freedoms"]}
        self.rest = {name: f["rest"] for name, f in self.freedoms.items()}
        self.frames = {name: framed(j["parent_frame"], j["child_frame"]) for name, j in self.joints.items()}
        self.turns = {
            name: (np.array(f["turn"]), np.array(f["slide"]), any(f["turn"]), any(f["slide"])) for name, f in self.freedoms.items()
        }
        self.shells = functools.cache(lambda name: shells(self.meshes[name]["vertices"], self.meshes[name]["triangles"]))
        self.reach, self.line, self.stretch = functools.cache(self.reached), functools.cache(self.pieces), functools.cache(self.stretched)
        self.ways = dict[Any, Any]()
        self.linked = [f["name"] for name in certificate["linkage"] for f in self.joints[name]["freedoms"]]
        ways = ([*self.way(j["parent"], j["child"]), (j, False)] for j in self.joints.values() if j["loop"])
        self.loops = [(way, self.around(way)) for way in ways]
        self.groups = self.grouped(certificate["mechanism"]["couplings"])
        self.pairs = functools.cache(lambda: grouped_by(certificate["pairs"], lambda pair: frozenset(pair["parts"])))

    def check(self) -> None:
        """Check every claim; if the certificate is marked ok, check that no claim is missing."""
        whole, claims = self.certificate, self.certificate["claims"]
        for name, entry in whole["meshes"].items():
            need(digest(**self.meshes[name]) == entry["sha256"], f"mesh of {name} is missing or different")
        self.check_joints(*(whole["mechanism"][key] for key in ("parts", "joints", "couplings")))
        for number, claim in enumerate(claims):
            try:
                self.prove(claim, {key: self.proof[f"{number}.{key}"] for key in COURSE})
            except Refuted as reason:
                raise Refuted(f"{'/'.join(claim['parts'])} over {', '.join(sorted(claim['vary']))}: {reason}") from None
        if whole["ok"]:
            for fault in self.tolerance.faults(self.meshes, self.together):
                raise Refuted(fault)
            self.check_complete()

    def check_complete(self) -> None:
        """Refute a certificate without a claim for each two parts over each joint, and each two joints, by which they can move."""
        whole = self.certificate
        for group in self.groups:
            driving, moving = ({self.freedoms[name]["joint"] for name in group if not few or name in self.drivers} for few in (True, False))
            need(
                {*whole["asked"]} & moving <= driving or driving <= {*whole["asked"]},
                f"not every driver of {', '.join(group)} was requested",
            )
            need(driving or not {*whole["asked"]} & moving or self.is_rigid(group), f"nothing drives {', '.join(group)}, yet they may move")
        for count in (1, 2) if whole["together"] else (1,):
            for a, b, over in self.missing(count):
                raise Refuted(f"{a}/{b} over {over}: no claim, but the certificate is marked ok")

    def missing(self, count: int | None = None) -> Iterator[tuple[str, str, str]]:
        """Yield two parts, and the sets of `count` joints, or of all, that can move them together without a claim that covers it."""
        whole = self.certificate
        waived = {frozenset(pair["parts"]) for pair in whole["pairs"] if pair["strength"]["kind"] == "waived"}
        claims = [claim for claim in whole["claims"] if self.tolerance.counts(claim)]
        ways = [{f["name"] for name in claim["via"] for f in self.joints[name]["freedoms"]} for claim in claims]
        said = grouped_by(zip(claims, ways, strict=True), lambda both: frozenset(both[0]["parts"]))
        for a, b in itertools.combinations(whole["meshes"], 2):
            if frozenset({a, b}) in waived or self.together(a, b):
                continue
            joints = [joint for joint, _ in self.way(a, b) if joint["freedoms"]]
            own, mine = {f["name"] for joint in joints for f in joint["freedoms"]}, said.get(frozenset({a, b}), [])
            free = [joint for joint in joints if joint["name"] in whole["asked"] and joint["name"] not in whole["linkage"]]
            units: list[Any] = [({f["name"] for f in joint["freedoms"]},) * 2 for joint in free]
            for group in (group for group in self.groups if own & {*group}):
                units += [({name}, {*group}) for name in self.drivers if name in group and self.freedoms[name]["joint"] in whole["asked"]]
            for some in itertools.combinations(units, count or len(units)):
                # joints outside the path of a claim do not move its two parts
                if not any(all(names <= {*claim["vary"]} or not whose & via for names, whose in some) for claim, via in mine) and some:
                    yield a, b, ", ".join(sorted(name for names, _ in some for name in names))

    def check_joints(self, parts: Any, joints: Any, couplings: Any) -> None:
        """Refute a malformed mechanism, and one whose loops and couplings are declared wrongly."""
        freedoms = [f for j in joints for f in j["freedoms"]]
        need((len(self.joints), len(self.freedoms)) == (len(joints), len(freedoms)), "a name occurs twice")
        is_tree = sum(not j["loop"] for j in joints) == len(parts) - 1 and all(self.way(parts[0], part) is not None for part in parts)
        need(is_tree, "a loop is declared not to be one")
        need(all(f["joint"] == j["name"] for j in joints for f in j["freedoms"]), "a coordinate is assigned to another joint")
        frames = np.array([np.eye(4), *(j[side] for j in joints for side in ("parent_frame", "child_frame"))])
        R, turns, slides = frames[:, :3, :3], *(np.array([f[key] for f in freedoms]).reshape(-1, 3) for key in ("turn", "slide"))
        off = np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max() + np.abs(frames[:, 3] - [0, 0, 0, 1]).max()
        need(off < ROUNDING and np.linalg.det(R).min() > 0 and np.abs(frames).max() < LARGEST, "a frame is not valid")
        sizes = np.linalg.norm(np.where(turns.any(1, keepdims=True), turns, slides), axis=1)
        need((np.abs([sizes - 1, *np.cross(turns, slides).T]) < ROUNDING).all(), "a joint neither rotates, slides nor screws")
        numbers = [end for f in freedoms for end in (*f["range"], f["rest"], *f["limits"]) if end is not None]
        need(all(-LARGEST < end < LARGEST for end in numbers) and all(f["range"][0] <= f["range"][1] for f in freedoms), "invalid range")
        for f in freedoms:
            open_ends = [end is None for end in f["limits"]]
            same = all(is_open or end == limit for is_open, end, limit in zip(open_ends, f["range"], f["limits"], strict=True))
            need(len(open_ends) == 2 and same, f"the range of {f['name']} differs from its limits")
        for ball in (j for j in joints if j["cone"] is not None):
            turn, slide, ends = (np.array([f[key] for f in ball["freedoms"]]) for key in ("turn", "slide", "range"))
            is_ball = np.array_equal(turn, np.eye(3)) and not slide.any() and (np.abs(ends).max(1) <= [np.pi, np.pi / 2, LARGEST]).all()
            need(is_ball and 0 <= ball["cone"] <= np.pi, "a joint with a cone is not a ball")  # turns about x, y and z
        tied = {joint["name"] for way, _ in self.loops for joint, _ in way}
        tied |= {j["name"] for j in joints for f in j["freedoms"] for c in couplings if f["name"] in (c["a"], c["b"])}
        need(self.certificate["linkage"] == sorted(tied), "a linked joint is declared independent, or an independent joint linked")
        self.begin(self.linked, 0)  # this also checks loops in which nothing moves

    def way(self, a: str, b: str, names: Any = None, *, whole: bool = True) -> Any:
        """Return the joints from a to b, each with whether it is crossed from parent to child: those named, or of the tree."""
        ways = self.reach(a, None if names is None else frozenset(names))
        need(b in ways or not whole, f"no joints lead from {a} to {b}")
        return ways.get(b)

    def reached(self, a: str, names: Any) -> dict[str, list[Any]]:
        """Return the way from a to each part that joints lead to: those named, or of the tree."""
        tree = (joint for joint in self.joints.values() if not joint["loop"])
        joints = list(tree if names is None else (self.joints[name] for name in sorted(names) if name in self.joints))
        steps = [(joint["parent"], joint["child"], (joint, True)) for joint in joints]
        steps += [(joint["child"], joint["parent"], (joint, False)) for joint in joints]
        leaving, ways = grouped_by(steps, lambda step: step[0]), {a: list[Any]()}
        for part in (todo := [a]):
            for _, far, step in leaving.get(part, ()):
                if far not in ways:
                    ways[far] = [*ways[part], step]
                    todo.append(far)
        return ways

    def together(self, a: str, b: str) -> bool:
        """Return whether no joint moves two parts against each other."""
        return self.way(a, b, self.fixed, whole=False) is not None

    def grouped(self, couplings: Any) -> list[list[str]]:
        """Return the coordinates that loops and couplings connect, grouped by what moves together; couplings connect coordinates, not joints."""
        found: list[set[str]] = []
        ties = [{f["name"] for joint, _ in way for f in joint["freedoms"]} for way, _ in self.loops]
        for tie in [*ties, *({c["a"], c["b"]} for c in couplings), *({name} for name in self.linked)]:
            apart = [group for group in found if not group & tie]
            found = [*apart, tie.union(*(group for group in found if group & tie))]
        return [[name for name in self.linked if name in group] for group in found if group]

    def steps_on(self, way: list[Any]) -> Any:
        """Return the freedoms on a path, their motions (signed spins and slides), the frames before each, and the last one."""
        key = tuple((joint["name"], forward) for joint, forward in way)
        if key not in self.ways:
            names, moves, frames, still = list[str](), list[Any](), list[Any](), np.eye(4)
            for joint, forward in way:
                sign, (before, after) = (1, self.frames[joint["name"]][0]) if forward else (-1, self.frames[joint["name"]][1])
                still = still @ before
                for f in joint["freedoms"][::sign]:
                    names, moves, frames = (
                        [*names, f["name"]],
                        [*moves, [sign * part for part in self.turns[f["name"]][:2]]],
                        [*frames, still],
                    )
                    still = np.eye(4)
                still = still @ after
            turns, slides = np.moveaxis(np.array(moves).reshape(-1, 2, 3), 1, 0)
            self.ways[key] = names, turns, slides, np.array([*frames, still]), spins(turns)
        return self.ways[key]

    def place(self, way: list[Any], values: Any) -> tuple[Any, dict[str, Any]]:
        """Return T_a_b, and for each freedom on the path its axis and its speed at a's origin, in the frame of a.

        Values are numbers, or arrays of one shape `(...)` for many poses at once: T is (..., 4, 4), axes and speeds are (..., 3).
        """
        T, names, axes, speeds = self.placed(way, values)
        return T, dict(zip(names, zip(axes, speeds, strict=True), strict=True))

    def placed(self, way: list[Any], values: Any) -> tuple[Any, list[str], Any, Any]:
        """Return the same with axes and speeds as arrays `(freedoms, ..., 3)`."""
        names, turns, slides, frames, spin = self.steps_on(way)
        if not names:
            return frames[0], names, np.empty((0, 3)), np.empty((0, 3))
        angles = np.stack(np.broadcast_arrays(*(values[name] for name in names)))
        wide = (len(names), *(1,) * (angles.ndim - 1))
        K, a, slide = spin.reshape(*wide, 4, 4), angles[..., None, None], np.zeros((*angles.shape, 4, 4))
        slide[..., :3, 3] = slides.reshape(*wide, 3) * angles[..., None]
        motions = np.eye(4) + np.sin(a) * K + (1 - np.cos(a)) * (K @ K) + slide  # Rodrigues; a joint that turns slides only along its axis
        motions, at = motions @ frames[1:].reshape(*wide, 4, 4), [np.broadcast_to(frames[0], (*angles.shape[1:], 4, 4))]
        for motion in motions:
            at.append(at[-1] @ motion)
        before = np.array(at[:-1])
        R, o = before[..., :3, :3], before[..., :3, 3]
        axes, along = ((R @ part.reshape(*wide, 3, 1))[..., 0] for part in (turns, slides))
        return at[-1], names, axes, along + cross(o, axes)

    def around(self, way: list[Any]) -> tuple[Any, float]:
        """Return the first corner of a loop, and the length of the loop: the sum of distances between joints along its parts."""
        ends = []
        for joint, forward in way:
            ends += [joint[f"{side}_frame"] for side in (("parent", "child") if forward else ("child", "parent"))]
        corners = [[row[3] for row in frame[:3]] for frame in ends]
        return np.array(corners[0]), sum(
            math.dist(far, near) for far, near in zip(corners[1::2], [*corners[2::2], corners[0]], strict=True)
        )

    def closure(self, names: list[str], values: Any, about: Any) -> tuple[Any, Any, Any]:
        """Return residuals r of loops and couplings, their Jacobian, and shares s: the k-th derivative of r is at most (s · change)^k, k > 1.

        Values are (..., n); r is (..., m), the Jacobian (..., m, n). Constraints in which none of the names takes part are left out.
        A loop R, t leaves its gap at the first corner, and the vector of (R - R')/2, whose derivative for a turn w is (tr R - R) w / 2.
        Lengths are divided by a lever: no turn moves a point of the loop by more than one lever as long as no slide is farther from 0
        than 1 more than twice what it is `about` (..., n).
        """
        batch, n = values.shape[:-1], len(names)
        known, size = {**self.rest, **dict(zip(names, np.moveaxis(values, -1, 0), strict=True))}, np.moveaxis(np.abs(about), -1, 0)
        column = {name: at for at, name in enumerate(names)}
        r, J, shares = [np.zeros((*batch, 0))], [np.zeros((*batch, 0, n))], [np.zeros((*about.shape[:-1], 0, n))]
        for way, (start, length) in self.loops:
            moving = [f["name"] for joint, _ in way for f in joint["freedoms"]]
            mine = [name for name in moving if name in column]
            if moving and not mine:
                continue
            # the loop as one product of its joints: R, t must be the identity
            T, on_way, axes, speeds = self.placed(way, known)
            R = T[..., :3, :3]
            need(np.abs(R - np.eye(3)).max() < HALF, "a loop is not closed")  # half a turn has no residual either
            # lever: length of the loop plus twice the reach of its slides
            distances = [math.hypot(*self.freedoms[name]["slide"]) for name in moving]
            far = [1 + (size[column[name]] if name in column else abs(self.rest[name])) for name in moving]
            lever = np.broadcast_to(length + sum(2 * slide * reach for slide, reach in zip(distances, far, strict=True)), about.shape[:-1])
            lever = np.where(lever > 0, lever, 1.0)
            # r = ((R p + t − p)/lever, vee((R − Rᵀ)/2))
            there = R @ start + T[..., :3, 3]
            gap = (T[..., [2, 0, 1], [1, 2, 0]] - T[..., [1, 2, 0], [2, 0, 1]]) / 2
            r.append(np.broadcast_to(np.concatenate([(there - start) / lever[..., None], gap], axis=-1), (*batch, 6)))
            block, share, at = np.zeros((*batch, 6, n)), np.zeros((*about.shape[:-1], 6, n)), [column[name] for name in mine]
            if mine:
                moved = [on_way.index(name) for name in mine]
                w, v = np.moveaxis(axes[moved], 0, -2), np.moveaxis(speeds[moved], 0, -2)
                # dr for a twist (w, v): ((v + w × p)/lever, (tr R − R) w / 2)
                turn = (np.trace(R, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - R) / 2
                block[..., :3, at] = (v + cross(w, there[..., None, :])).swapaxes(-1, -2) / lever[..., None, None]
                block[..., 3:, at] = turn @ w.swapaxes(-1, -2)
                share[..., at] = np.where([self.turns[name][2] for name in mine], 1.0, 1 / lever[..., None])[..., None, :]
            J.append(block)
            shares.append(share)
        for c in self.certificate["mechanism"]["couplings"]:
            if c["a"] in column or c["b"] in column:
                r.append(np.broadcast_to(known[c["b"]] - c["ratio"] * known[c["a"]] - c["offset"], batch)[..., None])
                row = np.array([float(name == c["b"]) - c["ratio"] * (name == c["a"]) for name in names])
                J.append(np.broadcast_to(row, (*batch, 1, n)))
                shares.append(np.zeros((*about.shape[:-1], 1, n)))
        return np.concatenate(r, axis=-1), np.concatenate(J, axis=-2), np.concatenate(shares, axis=-2)

    def enclosures(self, names: list[str], ends: Any, guess: Any) -> tuple[Any, ...]:
        """Bound, for pieces of drivers' ranges `(k, drivers, 2)`, how a Newton map moves points near a curve through a guess `(k, n)`.

        The first of the names drive: t from -1 to 1 for each. The followers are near x(t) = guess + S t + t'Qt/2. The map of a deviation
        d is
        d - A(t) r(x(t) + d), with A(t) = (1 - sum t_k L_k) A, A the inverse of the Jacobian in the middle, and L_k its relative rate.
        Both
        A(t) r and A(t) J - 1 are interpolated on a grid of `NODES`; the largest Bernstein coefficient bounds a polynomial. The error of an
        interpolation is `QUINTIC` of the fifth derivative; along t_k, derivatives of r(x(t)) are below those of exp(v t + a t^2/2).

        Returns S `(k, drivers, n)`; Q `(k, drivers², n)`; bounds of A r `(k, n)`, of |A J - 1| `(k, n, n)`, and of |A| `(k, n, m)`; shares.
        """
        count, half = ends.shape[1], np.ptp(ends, axis=2) / 2
        r, J, share = self.closure(names, guess, guess)
        # A: inverse of the followers' Jacobian in the middle; S = −A J_drivers: slopes of the followers
        A, S = np.linalg.pinv(J[..., count:], rcond=1e-7), np.zeros((*guess.shape[:1], count, len(names)))
        S[..., :count], S[..., count:] = np.eye(count), -(A @ J[..., :count]).swapaxes(1, 2)
        few = (np.abs(A @ J[..., count:] - np.eye(len(names) - count)).sum(2) < ROUNDING).all(1)
        fits = few & (guess[:, :count] == ends.mean(2)).all(1)
        fits &= np.abs(np.concatenate([r, (J @ S.swapaxes(1, 2)).reshape(len(r), -1)], axis=1)).max(1, initial=0.0) < (
            ROUNDING if count else REST
        )
        need(fits.all(), f"{', '.join(names[:count])} cannot be at {guess[~fits][:1, :count].round(9).tolist()}, or not only there")
        S, Q = S * half[..., None], np.zeros((len(guess), count**2, len(names)))

        def powers(t: Any) -> Any:  # t_k t_l / 2
            return (t[:, :, None] * t[:, None]).reshape(len(t), -1) / 2

        # Q: fit of a quadratic to the residuals along the slopes, which it cancels
        t = corners_of(count, (-1, 0, 1))
        fit = np.linalg.pinv(np.concatenate([np.ones((len(t), 1)), t, powers(t)], axis=1))[1 + count :]
        Q[..., count:] = -fit @ self.closure(names, guess[:, None] + t @ S, guess[:, None])[0] @ A.swapaxes(1, 2)
        # L_k: relative rate of the Jacobian along t_k, by least squares over the nodes
        t = corners_of(count, NODES)
        r, J, _ = self.closure(names, guess[:, None] + t @ S + powers(t) @ Q, guess[:, None])
        L = A[:, None] @ np.tensordot(np.linalg.pinv(t), J[..., count:], (1, 1)).swapaxes(0, 1)
        rates = L @ A[:, None]
        at = A[:, None] - np.tensordot(t, rates, (1, 1)).swapaxes(0, 1)
        off, bend, most = (at @ r[..., None])[..., 0], at @ J[..., count:] - np.eye(len(names) - count), np.abs(at).max(1)
        # a polynomial is bounded by its largest Bernstein coefficient
        bernstein = functools.reduce(np.kron, [np.eye(1), *[BERNSTEIN] * count])
        off, bend = (np.abs(np.tensordot(bernstein, part, (1, 1))).max(0) for part in (off, bend))
        for k in range(count):
            v, a = (
                share @ part[..., None]
                for part in (np.abs(S[:, k]) + np.abs(Q[:, k * count : (k + 1) * count]).sum(1), np.abs(Q[:, k * (count + 1)]))
            )
            fifth, fourth = (v**5 + 10 * v**3 * a + 15 * v * a**2).swapaxes(1, 2), (v**4 + 6 * v**2 * a + 3 * a**2).swapaxes(1, 2)
            rest = (most * fifth + 5 * np.abs(rates[:, k]) * fourth) * QUINTIC * LEBESGUE**k
            off, bend = off + rest.sum(2), bend + rest @ share[..., count:]
        return ends, guess, S, Q, off + ROUNDING, bend, most, share

    def held(self, names: list[str], bounds: tuple[Any, ...], wide: Any) -> list[Any]:
        """Return pieces with the distances from their curves within which there is a solution, the only one within `wide` `(k, n)`.

        If the Newton map takes the set within `wide` to a smaller one, it also shrinks distances: Brouwer and Banach. A piece is its
        ends; value, rates and distance of a line; and for its tube the guess, the curve, the distance, and `wide`.
        """
        ends, guess, S, Q, off, bend, most, share = bounds
        count, half, far = ends.shape[1], np.ptp(ends, axis=2) / 2, np.abs(S).sum(1) + np.abs(Q).sum(1) / 2
        bends, near = share.any(1), wide.copy()  # coordinates that no loop moves are in couplings alone, which are exact
        near[:, :count] = 0.0
        holds = (wide >= 0).all(1) & ((far + wide <= 1 + np.abs(guess)) | ~bends).all(1) & (share @ (far + wide)[..., None] < 1).all((1, 2))
        for _ in range(4):
            close = near[:, count:, None]
            closer = (off[..., None] + bend @ close + most @ (share[..., count:] @ close) ** 2)[..., 0]
            good = holds & (closer <= near[:, count:]).all(1)
            need(good.all(), f"{', '.join(names[:count])} cannot be followed over {ends[~good][:1].round(9).tolist()}")
            near[:, count:] = closer
        square = Q.reshape(len(Q), count, count, len(names))
        bow = np.abs(square).sum((1, 2)) / 2 - np.abs(np.diagonal(square, 0, 1, 2)).sum(-1) / 4  # of t'Qt/2 beside its ends' mean
        half = np.where(half > 0, half, 1.0)
        value, rates = guess + np.diagonal(square, 0, 1, 2).sum(-1) / 4, S / half[..., None]
        curve = square / (half[:, :, None] * half[:, None])[..., None]
        tubes = zip(guess, curve, near, wide, strict=True)
        return list(zip(ends, value, rates, near + bow, tubes, strict=True))

    def followers(self, drivers: Any) -> list[str]:
        """Return drivers of one group and everything linked with them, except for its other drivers, which stay at rest."""
        (group,) = (group for group in self.groups if {*drivers} <= {*group})
        return [*drivers, *(name for name in group if name not in self.drivers)]

    def is_rigid(self, group: list[str]) -> bool:
        """Return whether coordinates without a driver cannot move: near rest, there is no other solution."""
        rest, wide = np.array([[self.rest[name] for name in group]]), np.full((1, len(group)), STIFF)
        try:
            self.held(group, self.enclosures(group, np.empty((1, 0, 2)), rest), wide)
        except Refuted:
            return False
        return True

    def join(self, found: list[Any], names: list[str], row: Any, other: int) -> None:
        """Add a piece of drivers' ranges to others if it contains the solution of one that is beside or around it, or at rest."""
        (ends, *_, (_, _, near, wide)), (span, *_, (_, _, close, apart)) = row, found[other]
        at = np.clip(ends.mean(1), *span.T)
        gap = np.abs(on_path(row, at) - on_path(found[other], at)) * (np.arange(len(names)) >= len(ends))
        same = (gap + near <= apart).all() or (gap + close <= wide).all()  # the solution in one is the only solution of the other
        need(
            same and (ends[:, 0] <= at).all() and (at <= ends[:, 1]).all(),
            f"{', '.join(names[: len(ends)])} leaves its branch at {at.round(9).tolist()}",
        )
        for name, (low, high) in zip(names[: len(ends)], ends, strict=True):
            need(not low < self.rest[name] < high, f"{name} is on both sides of rest")  # which may be a dead point
        found.append(row)

    def begin(self, names: list[str], count: int) -> list[Any]:
        """Return the rest pose as a piece, about which a solution is no farther than `REST`; the first of the names drive."""
        at, still = np.array([self.rest[name] for name in names]), np.zeros((count, len(names)))
        need(np.abs(self.closure(names, at, at)[0]).max(initial=0.0) < REST, "a loop or coupling is open at rest")
        near, nothing = REST * (np.arange(len(names)) >= count), np.zeros(len(names))
        return [(np.stack([at[:count]] * 2, axis=1), at, still, near, (at, np.zeros((count, *still.shape)), near, nothing))]

    def pieces(self, drivers: tuple[str, ...]) -> Any:
        """Return pieces of drivers' ranges, all on the branch of the rest pose, and how ranges are split into them; by their ends."""
        names, key = self.followers(drivers), "+".join(drivers)
        found = self.begin(names, len(drivers))
        ends, values, wide, others = (self.proof[f"{key}.{what}"] for what in ("ends", "values", "wide", "other"))
        need(len(ends) == len(values) == len(wide) == len(others), "a piece of a driver's range is missing")
        for start in range(0, len(ends), TUBES):
            some = slice(start, start + TUBES)
            bounds = self.enclosures(names, ends[some].reshape(-1, len(drivers), 2), values[some])
            for row, other in zip(self.held(names, bounds, wide[some]), others[some], strict=True):
                self.join(found, names, row, other)
        pieces = {boxed(row[0]): row for row in found[1:]}
        boxes, cuts, places = (self.proof.get(f"{key}.{what}", np.empty(0)) for what in ("boxes", "cuts", "at"))
        parted = zip(map(boxed, boxes.reshape(-1, len(drivers), 2)), zip(cuts.tolist(), places.tolist(), strict=True), strict=True)
        return pieces, dict(parted)

    def stretched(self, drivers: tuple[str, ...], box: Any) -> Any:
        """Return value, rates and distance by coordinate, over ranges of drivers: of all pieces into which these are split."""
        pieces, parted = self.line(drivers)
        todo, found = [box], []
        while todo:
            one = todo.pop()
            need(one in pieces or one in parted, f"{', '.join(drivers)} not followed over {np.round(box, 9).tolist()}")
            if one in pieces:
                found.append(one)
                continue
            cut, place = parted[one]
            need(one[cut][0] < place < one[cut][1], "a part of the range is missing")
            todo += [(*one[:cut], half, *one[cut + 1 :]) for half in ((one[cut][0], place), (place, one[cut][1]))]
        middle, slopes, near = joined(np.array(found), [pieces[one][1:4] for one in found])
        return dict(zip(self.followers(drivers), zip(middle, slopes.T, near, strict=True), strict=True))

    def check_range(self, name: str, low: float, high: float, *, is_driver: bool) -> None:
        """Refute a range that does not cover a coordinate's motion: for an endless one, a turn, or the period of its followers."""
        (least, most), (_, _, is_turn, is_slide) = self.freedoms[name]["limits"], self.turns[name]
        is_whole = (least is None or low < least + 1e-6) and (most is None or high > most - 1e-6)
        need(is_whole, f"not over the whole range of {name}")
        if least is None or most is None:
            need(is_turn and not is_slide, f"{name} slides without limits")
            need(high - low > 2 * math.pi - ROUNDING, f"not over a whole turn of {name}")
            need(not is_driver or self.is_repeated(name, low, high), f"the followers of {name} do not return over its range")

    def is_repeated(self, driver: str, low: float, high: float) -> bool:
        """Return whether all followers of a driver are at the end of a range where they were at its beginning, up to whole turns.

        Loops are the same after whole turns, couplings if these fit their ratio; so the motion repeats. Other drivers stand still here:
        when they move, the followers stay on the same branch.
        """
        names, (pieces, _) = self.followers((driver,)), self.line((driver,))
        first = [row for box, row in pieces.items() if box[0][0] == low]
        last = [row for box, row in pieces.items() if box[0][1] == high]
        need(first and last, f"{driver} is not followed from {low:.9g} to {high:.9g}")
        low_x, high_x = (self.settled(names, row, at) for row, at in ((first[0], low), (last[0], high)))
        shift = high_x - low_x
        turns = np.round(shift / (2 * math.pi)) * [self.turns[name][2] and not self.turns[name][3] for name in names]
        known = dict(zip(names, turns.tolist(), strict=True))
        ties = [(known.get(c["a"], 0.0) * c["ratio"], known.get(c["b"], 0.0)) for c in self.certificate["mechanism"]["couplings"]]
        fits = all(abs(one - other) <= FLOAT * max(1.0, abs(other)) for one, other in ties)
        return bool(fits and (np.abs(shift - 2 * math.pi * turns) < SETTLED).all())

    def settled(self, names: list[str], row: Any, at: float) -> Any:
        """Return the solution at an end of a piece of one driver's range, to within `SETTLED`: the only one within its tube there."""
        there, wide = on_path(row, np.array([at])), row[-1][-1]
        x = there.copy()
        for _ in range(5):
            r, J, _ = self.closure(names, x, x)
            x[1:] -= np.linalg.pinv(J[:, 1:], rcond=1e-7) @ r
        r = self.closure(names, x, x)[0]
        is_held = np.abs(r).max(initial=0.0) < ROUNDING and (np.abs(x - there)[1:] + SETTLED < wide[1:]).all()
        need(is_held, f"{names[0]} cannot be at {at:.9g}")
        return x

    def said(self, parts: set[str]) -> float:
        """Return the stated largest overlap depth of two parts; a waiver does not affect it."""
        found = [pair["strength"] for pair in self.pairs().get(frozenset(parts), ())]
        depths = [math.inf if how["kind"] == "waived" else how["epsilon_mm"] for how in found if how["kind"] in ("waived", "certified")]
        return max(depths, default=0.0)

    def prove(self, claim: dict[str, Any], proof: dict[str, Any]) -> None:
        """Check a claim: repeat the cuts of the proof, and check that the given direction separates the pieces of each row."""
        (a, b), vary, whole = claim["parts"], claim["vary"], self.certificate
        (V, F), (W, G) = ((self.meshes[name]["vertices"], self.meshes[name]["triangles"]) for name in (a, b))
        moved, order_a, order_b = (self.proof.get(name, 0.0) for name in proof["uses"].tolist())
        here, way = V + moved, self.way(a, b, claim["via"])
        T, steps = self.place(way, self.rest)
        least = [whole["meshes"][name]["deflection_mm"] for name in (a, b)]
        need(min(least) >= 0 and claim["clear_mm"] >= sum(least) - ROUNDING, "its clearance is less than the deflection of the meshes")
        need(claim["shrink_mm"] <= self.said({a, b}) + ROUNDING or not whole["ok"], "it allows more overlap than it states")
        need(here.shape == V.shape and np.linalg.norm(here - V, axis=1).max() <= claim["shrink_mm"] + ROUNDING, "it moves vertices further")
        lines = self.driven(way, vary)
        for name, (low, high) in vary.items():
            need(low <= self.rest[name] + ROUNDING and self.rest[name] <= high + ROUNDING, "not about the rest pose")
            if whole["ok"]:
                self.check_range(name, low, high, is_driver=any(name in drivers for drivers in lines))
        beside = W @ T[:3, :3].T + T[:3, 3]  # if none is inside the other here, surfaces that never meet keep it so
        for points, vertices, triangles in ((here[self.shells(a)], beside, G), (beside[self.shells(b)], here, F)):
            need(not is_inside(points, vertices, triangles), "one is inside the other at rest")
        boxes, moving, halves = self.boxes(way, vary, lines, proof)
        A, B, (centre, axis) = ordered(here[F], order_a), ordered(W[G], order_b), proof["about"]
        both = A - centre, B @ T[:3, :3].T + T[:3, 3] - centre
        turns = [joint for joint, _ in way if {f["name"] for f in joint["freedoms"]} & {*vary, *self.linked}]
        cone = turns[0]["cone"] if len(turns) == 1 and all(f["name"] in vary and not f["rest"] for f in turns[0]["freedoms"]) else None
        angles = [leans(local, steps[turns[0]["freedoms"][-1]["name"]][0]) for local in both if cone]
        near, far = zip(*(radii(local @ plane(axis)) for local in both), strict=True) if proof["codes"].min() <= ROUND else ((), ())
        outside = [swung(local, steps[turns[0]["freedoms"][-1]["name"]][0], cone) for local in both if cone and cone <= np.pi / 2]
        spans = [list(itertools.pairwise(proof[key].tolist())) for key in ("parts_a", "parts_b")]
        need([(own[0][0], own[-1][1]) for own in spans] == [(0, len(A)), (0, len(B))], "a triangle is missing")

        def kept(code: int, x: slice, y: slice, number: int) -> Any:
            box, is_steady = boxes[number]
            if code == OUTSIDE:
                return math.inf if any(is_outside(joint, box) for joint, _ in way if joint["cone"] is not None) else 0.0
            need(is_steady and (code == ROUND or (code == LEAN and angles) or (code == SWUNG and outside)), "its invariant does not hold")
            if code == ROUND:
                return max(near[0][x].min() - far[1][y].max(), near[1][y].min() - far[0][x].max())
            if code == SWUNG:
                return max(
                    (outside[1][0][y].min(0) - outside[0][1][x].max(0)).max(), (outside[0][0][x].min(0) - outside[1][1][y].max(0)).max()
                )
            over = angles[0][0][x].min() - angles[1][1][y], angles[1][0][y] - angles[0][1][x].max()  # a swing changes angles by no more
            return max((near[1][y] * np.sin(np.clip(side - cone, 0, np.pi / 2))).min() for side in over)  # than its own, a twist by none

        along = proof["along"] / np.linalg.norm(proof["along"], axis=1, keepdims=True), int(proof["of_a"])
        rows = np.array([(*one, *other, 0) for one, other in itertools.product(*spans)])
        follow(rows, proof["codes"], along, A, B, (moving, halves, kept), claim["clear_mm"])

    def driven(self, way: list[Any], vary: Any) -> list[tuple[str, ...]]:
        """Return the drivers of each group with followers on a path, which do not move independently."""
        here = {f["name"] for joint, _ in way for f in joint["freedoms"]} - set(vary)
        found = [tuple(name for name in self.drivers if name in group and name in vary) for group in self.groups if here & {*group}]
        return [drivers for drivers in found if drivers]

    def boxes(self, way: list[Any], vary: dict[str, Any], lines: Any, proof: dict[str, Any]) -> tuple[list[Any], list[Any], Any]:
        """Cut a range into boxes; return for each whether points keep their distance from an axis, and the centre poses and motions."""
        names, todo, halves = list(vary), [{name: (low, high) for name, (low, high) in vary.items()}], []
        (centre, axis), across, count = proof["about"], plane(proof["about"][1]), sum(map(len, lines))
        for box, cut, place in zip(todo, proof["cuts"].tolist(), proof["at"].tolist(), strict=True):
            if cut < 0:
                halves.append((-1, -1))
            else:
                (low, high), name = box[names[cut]], names[cut]
                need(low < place < high, "a part of the range is missing")
                halves.append((len(todo), len(todo) + 1))
                todo += [{**box, name: (low, place)}, {**box, name: (place, high)}]  # their number grows
        spans = {name: np.array([box[name] for box in todo]) for name in names}
        values = {name: (ends.mean(1), np.zeros((len(todo), count)), np.ptp(ends, axis=1) / 2) for name, ends in spans.items()}
        first = 0
        for drivers in lines:
            sides = np.stack([spans[name] for name in drivers], axis=1)
            rows = [self.stretch(drivers, boxed(ends)) for ends in sides]
            for n in (n for n in rows[0] if n in drivers or n not in vary):
                value, rates, near = (np.array(column) for column in zip(*(row[n] for row in rows), strict=True))
                along = np.zeros((len(todo), count))
                along[:, first : first + len(drivers)] = rates * np.ptp(sides, axis=2) / 2
                values[n] = value, along, near
            first += len(drivers)
        T, steps = self.place(way, {**self.rest, **{name: value for name, (value, *_) in values.items()}})
        T = np.broadcast_to(T, (len(todo), 4, 4))
        moved = [(*steps[name], *values[name][1:]) for name in steps if name in values]
        nothing: list[Any] = [np.zeros((1, 1, 3)), np.zeros((1, 1, 3)), np.zeros((1, 1, count)), np.zeros((1, 1))]
        parts = [np.stack(np.broadcast_arrays(*column), axis=1) for column in zip(*moved, strict=True)] if moved else nothing
        w, v, along, aside = (np.broadcast_to(part, (len(todo), *part.shape[1:])) for part in parts)
        turned = (np.abs(along).sum(2) + aside) * w.any(2)
        # A turn by d about one axis moves the end of another one by 2 sin(d/2) times the sine of the angle between both.
        tilted = np.linalg.norm(cross(w[:, :, None], w[:, None]), axis=3)
        off = [
            np.abs((v + cross(w, centre)) @ across).max((1, 2)),
            np.abs(cross(w, axis)).max((1, 2)),
            np.abs(across @ across - across).max(),
        ]
        steady = list(zip(todo, functools.reduce(np.maximum, off) < ROUNDING, strict=True))  # none of them moves about one axis or point
        outer = (2 * np.sin(np.minimum(turned, np.pi) / 2)[..., None] * np.triu(tilted, 1)).sum(1)
        return steady, [T[:, :3, :3], T[:, :3, 3], np.cross(w[:, :, None], np.eye(3)), v, along, aside, turned, outer], np.array(halves)
