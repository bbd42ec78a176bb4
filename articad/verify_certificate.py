"""Check a motion certificate without trusting it: what `articad verify-certificate` asks.

Written apart from the prover, with NumPy alone. A certificate claims that parts keep apart while joints move within ranges. Beside it
lies how that is seen: how to cut surfaces and ranges, and for each two pieces what keeps them apart. Nothing of that is believed and
nothing is sought here: every inequality is computed anew from meshes and joints, and no piece, range or pair may be missing.
"""

from __future__ import annotations

import functools
import hashlib
import itertools
import json
import math
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np

PROOF = "_proof"  # no part bears such a name
ROUNDING = 1e-9  # of ranges, distances, and what a driver moves
HALF = 0.5  # of entries of a rotation, by which a loop may be open: with a turn of less than 1 rad more it is not half a turn
ALIGNED = 1e-12  # sine of axes that are parallel
SIDES = np.array(list(itertools.product((0, 1), repeat=3)))
COURSE = ("uses", "parts_a", "parts_b", "about", "cuts", "at", "codes", "along", "of_a")  # arrays of every claim
REST = 1e-6  # rad or mm: by which what follows a driver may be off at rest
LARGEST = 1e7  # mm or rad: further out, numbers are rounded by more than matters
TYPES = {"f": "f8", "i": "i8", "u": "i8", "U": "U"}  # of arrays, by kind: short numbers overflow, and complex ones have no order
LEAN, ROUND, OUTSIDE = -6, -5, -4  # pieces differ in angle from a ball's axis, or in radius; a box lies outside the cone of a ball
CUT = -3  # and -2, -1: the piece of a, of b, or the box is cut


class Refuted(Exception):  # noqa: N818 - it is no error of the program
    """Says why a certificate proves nothing."""


def need(condition: Any, reason: str) -> None:
    """Refute the certificate unless a condition holds."""
    if not condition:
        raise Refuted(reason)


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return why a certificate file is refuted, nothing if it is accepted; `folder` holds `<part>.npz` of every part, and the proof."""
    try:
        certificate, arrays = json.loads(file.read_bytes()), dict[str, Any]()
        for name in [*certificate["meshes"], PROOF]:
            need(Path(name).name == name, "a mesh bears the name of no file")
            with (folder / f"{name}.npz").open("rb") as stream, np.load(stream, allow_pickle=False) as found:
                arrays[name] = {key: array.astype(TYPES[array.dtype.kind]) for key, array in found.items()}
        left = sorted({found.stem for found in folder.glob("*.npz")} - set(arrays))
        need(not left, f"it says nothing of {', '.join(left)}")
        Checker(certificate, arrays).check()
    except Refuted as reason:
        return [str(reason)]
    except Exception as error:  # noqa: BLE001 - what breaks its checker, in whatever way, proves nothing
        return [f"it cannot be read: {error!r}"[:500]]
    return []


def digest(vertices: Any, triangles: Any) -> str:
    """Return the hash of a mesh as it stands in a certificate."""
    v, f = np.ascontiguousarray(vertices, "<f8"), np.ascontiguousarray(triangles, "<i4")
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


def shells(V: Any, F: Any) -> Any:
    """Return a vertex of each connected piece of a mesh that is closed."""
    need(V.shape[1:] == F.shape[1:] == (3,) and np.abs(V).max() < LARGEST, "a mesh is none")
    label = np.arange(len(V))
    forth, back = (np.sort((F * len(V) + np.roll(F, step, 1)).ravel()) for step in (1, -1))  # edges, by their two ends
    need(np.array_equal(forth, back), "a mesh is open")
    while (label[F] != (least := label[F].min(1, keepdims=True))).any():
        np.minimum.at(label, F, least)
        label = label[label]
    return np.unique(label[F])


def is_inside(points: Any, corners: Any) -> bool:
    """Return whether a closed surface winds round one of some points, either way (van Oosterom and Strackee)."""
    for point in points:
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        if abs(np.arctan2((a * np.cross(b, c)).sum(1), below).sum()) > np.pi:  # half of what a surface winds round a point inside
            return True
    return False


def ordered(corners: Any, order: Any) -> Any:
    """Return all triangles in another order."""
    need(np.array_equal(np.sort(order), np.arange(len(corners))), "a triangle is left out")
    return corners[order]


def plane(axis: Any) -> Any:
    """Return the projection across a unit axis."""
    return np.eye(3) - np.outer(axis, axis)


def hull(corners: Any, span: tuple[int, int], known: dict[tuple[int, int], Any]) -> Any:
    """Return points whose hull holds a piece: the corners of a triangle or two, else of a box."""
    if span not in known:
        points = corners[slice(*span)].reshape(-1, 3)
        known[span] = points if len(points) < len(SIDES) else np.stack([points.min(0), points.max(0)])[SIDES, [0, 1, 2]]
    return known[span]


def radii(flat: Any) -> tuple[Any, Any]:
    """Return the least and largest distance of triangles `(n, 3, 3)` from 0."""
    edge = np.roll(flat, -1, 1) - flat
    n, along = np.cross(edge[:, 0], edge[:, 1]), -(flat * edge).sum(2) / np.maximum((edge**2).sum(2), 1e-300)
    least = np.linalg.norm(flat + np.clip(along, 0, 1)[..., None] * edge, axis=2).min(1)
    over = (np.cross(n[:, None], edge) * -flat).sum(2).min(1) > 0  # 0 lies above the triangle, or below it
    height = np.abs((n * flat[:, 0]).sum(1)) / np.maximum(np.linalg.norm(n, axis=1), 1e-300)
    return np.where(over, np.minimum(least, height), least), np.linalg.norm(flat, axis=2).max(1)


def leans(local: Any, axis: Any) -> tuple[Any, Any]:
    """Return between which angles from an axis through 0 triangles `(n, 3, 3)` are."""
    height, wide = local @ axis, radii(local @ plane(axis))
    ends = np.arctan2(wide, height.max(1)), np.arctan2(wide, height.min(1))
    return ends[0].min(0), ends[1].max(0)


def joined(ends: Any, rows: list[Any]) -> tuple[Any, Any, Any]:
    """Return pieces of a driver's range in a row as one: value and rate of a line from end to end, and how far from it they are."""
    (value, rate, near), half = (np.array(column) for column in zip(*rows, strict=True)), np.diff(ends)[:, None] / 2
    at = np.stack([value - rate * half, value + rate * half])
    middle, slope = (at[0, 0] + at[1, -1]) / 2, (at[1, -1] - at[0, 0]) / (ends[-1] - ends[0])
    places = np.stack([ends[:-1], ends[1:]]) - (ends[0] + ends[-1]) / 2
    return middle, slope, (np.abs(at - middle - slope * places[..., None]) + near).max((0, 1))


def is_outside(ball: dict[str, Any], box: dict[str, tuple[float, float]]) -> bool:
    """Return whether a box lies outside the cone of a ball: turns x and y swing it by acos(cos x · cos y)."""
    x, y = (max(box[f["name"]][0], -box[f["name"]][1], 0.0) for f in ball["freedoms"][:2])
    return max(x, y) < math.pi / 2 and math.cos(x) * math.cos(y) < math.cos(ball["cone"]) - ROUNDING


def motion(u: Any, p: Any, spins: Any, v: Any, along: Any, aside: Any, turned: Any, outer: Any) -> Any:
    """Bound how far points `(n, 3)` go along a direction while what moves goes `along` together and `aside` each, `(n,)`.

    That is their speed, and half the second derivative: along u the factor i outside j turns what j moves by |u x axis i|.
    """
    across, width, turns = spins @ u, np.abs(along) + aside, turned > 0  # spins: p @ spin is axis x p
    speeds, reach, inside = p @ across.T + v @ u, np.linalg.norm(p @ spins + v[:, None], axis=2), 0.0
    moved, tilt = np.abs(speeds @ along) + np.abs(speeds) @ aside, np.minimum(np.linalg.norm(across, axis=1) + outer, 1.0) * turned
    for f, share in reversed(list(enumerate(np.cumsum(tilt) - tilt / 2))):
        carried = width[f] * (reach[f] + inside * turns[f])
        moved, inside = moved + carried * share, inside + carried
    return moved


class Checker:
    """A certificate, its meshes and its proof."""

    def __init__(self, certificate: dict[str, Any], arrays: dict[str, dict[str, Any]]) -> None:
        self.certificate, self.meshes, self.proof = certificate, arrays, arrays[PROOF]
        self.joints, self.drivers = {joint["name"]: joint for joint in certificate["mechanism"]["joints"]}, list(certificate["drivers"])
        self.freedoms = {f["name"]: f for joint in self.joints.values() for f in joint["freedoms"]}
        self.rest, self.lines = {name: f["rest"] for name, f in self.freedoms.items()}, dict[str, dict[Any, Any]]()
        self.shells = functools.cache(lambda name: shells(self.meshes[name]["vertices"], self.meshes[name]["triangles"]))
        self.linked = [f["name"] for name in certificate["linkage"] for f in self.joints[name]["freedoms"]]
        self.loops = [[*self.way(j["parent"], j["child"]), (j, False)] for j in self.joints.values() if j["loop"]]

    def check(self) -> None:
        """Prove every claim; of what calls itself ok, find what is missing."""
        whole, claims = self.certificate, self.certificate["claims"]
        for name, entry in whole["meshes"].items():
            need(digest(**self.meshes[name]) == entry["sha256"], f"mesh of {name} is missing or another")
        self.check_joints(*(whole["mechanism"][key] for key in ("parts", "joints", "couplings")))
        for number, claim in enumerate(claims):
            try:
                self.prove(claim, {key: self.proof[f"{number}.{key}"] for key in COURSE})
            except Refuted as reason:
                raise Refuted(f"{'/'.join(claim['parts'])} over {', '.join(sorted(claim['vary']))}: {reason}") from None
        waived = [set(pair["parts"]) for pair in whole["pairs"] if pair["strength"]["kind"] == "waived"]
        for a, b in itertools.combinations(whole["meshes"] if whole["ok"] else (), 2):
            moving = {joint["name"]: {f["name"] for f in joint["freedoms"]} for joint, _ in self.way(a, b)}
            free = [names for joint, names in moving.items() if joint in whole["asked"] and joint not in whole["linkage"]]
            drivers = [{name} for name in self.drivers if any(names & set(self.linked) for names in moving.values())]
            both = [one | other for one in free for other in [*free, *drivers] if whole["together"]]
            for names in filter(None, [] if {a, b} in waived else [*free, *drivers, *both]):
                found = any(set(claim["parts"]) == {a, b} and names <= set(claim["vary"]) for claim in claims)
                need(found, f"{a}/{b} over {', '.join(sorted(names))}: no claim, yet the certificate calls itself ok")
        need(self.drivers or not (whole["ok"] and {*whole["linkage"]} & {*whole["asked"]}), "nothing drives loops, yet it calls itself ok")

    def check_joints(self, parts: Any, joints: Any, couplings: Any) -> None:
        """Refute what is no mechanism, or is said to move otherwise than its loops and couplings let it."""
        freedoms = [f for j in joints for f in j["freedoms"]]
        need((len(self.joints), len(self.freedoms)) == (len(joints), len(freedoms)), "a name stands twice")
        is_tree = sum(not j["loop"] for j in joints) == len(parts) - 1 and all(self.way(parts[0], part) is not None for part in parts)
        need(is_tree, "a loop is said to be none")
        frames = np.array([np.eye(4), *(j[side] for j in joints for side in ("parent_frame", "child_frame"))])
        R, turns, slides = frames[:, :3, :3], *(np.array([f[key] for f in freedoms]).reshape(-1, 3) for key in ("turn", "slide"))
        off = np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max() + np.abs(frames[:, 3] - [0, 0, 0, 1]).max()
        need(off < ROUNDING and np.linalg.det(R).min() > 0 and np.abs(frames).max() < LARGEST, "a frame is none")
        sizes = np.linalg.norm(np.where(turns.any(1, keepdims=True), turns, slides), axis=1)
        need((np.abs([sizes - 1, *np.cross(turns, slides).T]) < ROUNDING).all(), "a joint neither turns, slides nor screws")
        need(all(-LARGEST < f["range"][0] <= f["range"][1] < LARGEST and abs(f["rest"]) < LARGEST for f in freedoms), "a range is none")
        for ball in (j for j in joints if j["cone"] is not None):
            turn, slide, ends = (np.array([f[key] for f in ball["freedoms"]]) for key in ("turn", "slide", "range"))
            is_ball = np.array_equal(turn, np.eye(3)) and not slide.any() and (np.abs(ends).max(1) <= [np.pi, np.pi / 2, LARGEST]).all()
            need(is_ball and 0 <= ball["cone"] <= np.pi, "what has a cone is no ball")  # turns about x, y and z
        tied = {joint["name"] for way in self.loops for joint, _ in way}
        tied |= {j["name"] for j in joints for f in j["freedoms"] for c in couplings if f["name"] in (c["a"], c["b"])}
        need(self.certificate["linkage"] == sorted(tied), "what is linked is said to move by itself, or the other way round")

    def way(self, a: str, b: str, names: Any = None) -> list[Any]:
        """Return the joints from a to b, each with whether it is crossed from parent to child: those named, or of the tree."""
        ways: dict[str, list[Any]] = {a: []}
        for part in (todo := [a]):
            for joint in self.joints.values():
                for near, far, forward in ((joint["parent"], joint["child"], True), (joint["child"], joint["parent"], False)):
                    if near == part and far not in ways and (not joint["loop"] if names is None else joint["name"] in names):
                        ways[far] = [*ways[part], (joint, forward)]
                        todo.append(far)
        need(b in ways, f"no joints lead from {a} to {b}")
        return ways[b]

    def place(self, way: list[Any], values: dict[str, float]) -> tuple[Any, dict[str, Any]]:
        """Return T_a_b, and of each freedom on the way its axis and its speed at a's origin, as a sees them."""
        T, steps = np.eye(4), {}
        for joint, forward in way:
            before, after, sign = np.array(joint["parent_frame"]), np.linalg.inv(joint["child_frame"]), 1 if forward else -1
            T = T @ (before if forward else np.linalg.inv(after))
            for f in joint["freedoms"][::sign]:
                axis, angle, motion = sign * T[:3, :3] @ f["turn"], sign * values[f["name"]], np.eye(4)
                steps[f["name"]] = axis, sign * T[:3, :3] @ f["slide"] + np.cross(T[:3, 3], axis)
                K = np.cross(f["turn"], np.eye(3)).T
                motion[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K  # Rodrigues
                motion[:3, 3] = np.multiply(f["slide"], angle)
                T = T @ motion
            T = T @ (after if forward else np.linalg.inv(before))
        return T, steps

    def closure(self, names: list[str], values: Any, about: Any) -> tuple[Any, Any, Any]:
        """Return residuals of loops and couplings, their Jacobian, and shares s: |r''| <= (s · change)², and the third is below its cube.

        Lengths are in levers: no turn carries what is round a loop by more than one while no slide is further from 0 than 1 more
        than twice what it is `about`.
        """
        known, r, J, shares = {**self.rest, **dict(zip(names, values.tolist(), strict=True))}, [], [], []
        size = {**self.rest, **dict(zip(names, about.tolist(), strict=True))}
        for way in self.loops:
            (T, steps), ends = self.place(way, known), []
            need(np.abs(T[:3, :3] - np.eye(3)).max() < HALF, "a loop is not closed")  # half a turn leaves no residual either
            for joint, forward in way:
                ends += [np.array(joint[f"{side}_frame"])[:3, 3] for side in (("parent", "child") if forward else ("child", "parent"))]
            lever: Any = sum(math.dist(far, near) for far, near in zip(ends[1::2], [*ends[2::2], ends[0]], strict=True))
            lever += sum(2 * math.hypot(*self.freedoms[name]["slide"]) * (1 + abs(size[name])) for name in steps)
            lever, there = lever or 1.0, T[:3, :3] @ ends[0] + T[:3, 3]
            columns = {name: np.concatenate([(v + np.cross(w, there)) / lever, w]) for name, (w, v) in steps.items()}
            r += [*(there - ends[0]) / lever, *((T[[2, 0, 1], [1, 2, 0]] - T[[1, 2, 0], [2, 0, 1]]) / 2)]
            J += np.transpose([columns.get(name, np.zeros(6)) for name in names]).tolist()
            shares += [[(name in steps) * (1.0 if any(self.freedoms[name]["turn"]) else 1 / lever) for name in names]] * 6
        for c in self.certificate["mechanism"]["couplings"]:
            r.append(known[c["b"]] - c["ratio"] * known[c["a"]] - c["offset"])
            J.append([float(name == c["b"]) - c["ratio"] * (name == c["a"]) for name in names])
            shares.append([0.0] * len(names))
        return np.array(r), np.array(J), np.array(shares)

    def piece(self, names: list[str], ends: Any, guess: Any, wide: Any) -> tuple[Any, Any]:
        """Return rates, and distances from the line that they draw within which is a solution; within `wide` there is no other one.

        As soon as x - A r(x) takes what is within `wide` to what is nearer, it also shrinks distances: Brouwer and Banach. On the line
        A r is near the parabola through three of its points, which is within 5/4 of them.
        """
        r, J, share = self.closure(names, guess, guess)
        A, half = np.linalg.pinv(J[:, 1:], rcond=1e-7), (ends[1] - ends[0]) / 2
        rate, B = np.array([1.0, *(-A @ J[:, 0])]), np.abs(A)
        need(guess[0] == ends.mean() and np.abs([r, J @ rate]).max() < ROUNDING, f"{names[0]} cannot be at {guess[0]:.9g}, or not alone")
        far, near = np.abs(rate) * half, wide
        off = np.max([np.abs(A @ self.closure(names, guess + sign * half * rate, guess)[0]) for sign in (-1, 0, 1)], axis=0)
        off = 1.25 * off + B @ (share @ far) ** 3 / 15 + ROUNDING
        exact = (np.abs(A @ J[:, 1:] - np.eye(len(names) - 1)).sum(1) < ROUNDING).all()
        holds = exact and (far + wide <= 1 + np.abs(guess)).all() and (share @ (far + wide) < 1).all()
        for _ in range(4):
            closer = np.append(0.0, off + B @ ((share @ (far + near)) * (share @ near)))
            need(holds and (closer <= near).all(), f"{names[0]} cannot be followed from {ends[0]:.9g} to {ends[1]:.9g}")
            near = closer
        return rate, near

    def followers(self, driver: str) -> list[str]:
        """Return a driver and all that is linked, but for other drivers, which stand."""
        return [driver, *(n for n in self.linked if n != driver and n not in self.drivers)]

    def join(self, found: list[Any], names: list[str], ends: Any, guess: Any, wide: Any, other: int) -> None:
        """Add a piece of a driver's range to others if it holds the solution of one that is beside or around it, or at rest."""
        rate, near = self.piece(names, ends, guess, wide)
        span, there, slope, close, apart = found[other]
        at = np.clip(ends.mean(), *span)
        gap = np.abs(guess + rate * (at - ends.mean()) - there - slope * (at - span.mean()))
        same = (gap + near <= apart).all() or (gap + close <= wide).all()  # what one holds is the only solution that the other has
        need(same and ends[0] <= at <= ends[1], f"{names[0]} leaves its branch at {at:.9g}")
        need(not ends[0] < self.rest[names[0]] < ends[1], f"{names[0]} is on both sides of rest")  # which may be a dead point
        found.append((ends, guess, rate, near, wide))

    def begin(self, names: list[str]) -> list[Any]:
        """Return the rest pose as a piece, about which a solution is no further than `REST`."""
        at, still = np.array([self.rest[name] for name in names]), np.zeros(len(names))
        need(np.abs(self.closure(names, at, at)[0]).max() < REST, "a loop or coupling is open at rest")
        return [(at[[0, 0]], at, still, REST * (np.arange(len(names)) > 0), still)]

    def line(self, driver: str) -> dict[float, dict[float, Any]]:
        """Return pieces of a driver's range, by where they begin and end: values, rates, distances; all on the branch of the rest pose."""
        if driver not in self.lines:
            names = self.followers(driver)
            found = self.begin(names)
            for row in zip(*(self.proof[f"{driver}.{key}"] for key in ("ends", "values", "wide", "other")), strict=True):
                self.join(found, names, *row)
            self.lines[driver] = {}
            for (low, high), *row, _ in found[1:]:
                self.lines[driver].setdefault(low, {})[high] = row
        return self.lines[driver]

    def stretch(self, driver: str, low: float, high: float) -> dict[str, Any]:
        """Return values, rates and distances by coordinate, over a stretch of a driver's range: of all pieces from one end to the other."""
        stops, rows = [low], []
        while stops[-1] < high:
            ends = [end for end in self.line(driver).get(stops[-1], {}) if stops[-1] < end <= high]
            need(ends, f"{driver} is not followed from {stops[-1]:.9g} to {high:.9g}")
            rows.append(self.line(driver)[stops[-1]][max(ends)])
            stops.append(max(ends))
        return dict(zip(self.followers(driver), zip(*joined(np.array(stops), rows), strict=True), strict=True))

    def said(self, parts: set[str]) -> float:
        """Return how deep two parts are said to overlap at most; a waiver says nothing of that."""
        found = [pair["strength"] for pair in self.certificate["pairs"] if {*pair["parts"]} == parts]
        depths = [math.inf if how["kind"] == "waived" else how["epsilon_mm"] for how in found if how["kind"] in ("waived", "certified")]
        return max(depths, default=0.0)

    def prove(self, claim: dict[str, Any], proof: dict[str, Any]) -> None:
        """Prove a claim: cut pieces of both surfaces and of the range as written, until what is written keeps each two apart."""
        (a, b), vary, whole = claim["parts"], claim["vary"], self.certificate
        (V, F), (W, G) = ((self.meshes[name]["vertices"], self.meshes[name]["triangles"]) for name in (a, b))
        moved, order_a, order_b = (self.proof.get(name, 0.0) for name in proof["uses"].tolist())
        here, way = V + moved, self.way(a, b, claim["via"])
        T, steps = self.place(way, self.rest)
        least = [whole["meshes"][name]["deflection_mm"] for name in (a, b)]
        need(min(least) >= 0 and claim["clear_mm"] >= sum(least) - ROUNDING, "it keeps less than the deflection of the meshes")
        need(claim["shrink_mm"] <= self.said({a, b}) + ROUNDING or not whole["ok"], "it allows more overlap than it says")
        need(here.shape == V.shape and np.linalg.norm(here - V, axis=1).max() <= claim["shrink_mm"] + ROUNDING, "it moves vertices further")
        for name, (low, high) in vary.items():
            lower, upper = self.freedoms[name]["range"]
            need((low < lower + 1e-6 and high > upper - 1e-6) or not whole["ok"], f"not over the whole range of {name}")
            need(low <= self.rest[name] + ROUNDING and self.rest[name] <= high + ROUNDING, "not about the rest pose")
        beside = W @ T[:3, :3].T + T[:3, 3]  # if none is inside the other here, surfaces that never meet keep it so
        for points, corners in ((here[self.shells(a)], beside[G]), (beside[self.shells(b)], here[F])):
            need(not is_inside(points, corners), "one is inside the other at rest")
        boxes, halves = self.boxes(way, vary, proof)
        A, B, (centre, axis) = ordered(here[F], order_a), ordered(W[G], order_b), proof["about"]
        both = A - centre, B @ T[:3, :3].T + T[:3, 3] - centre
        near, far = zip(*(radii(local @ plane(axis)) for local in both), strict=True)
        turns = [joint for joint, _ in way if {f["name"] for f in joint["freedoms"]} & {*vary, *self.linked}]
        cone = turns[0]["cone"] if len(turns) == 1 and all(f["name"] in vary and not f["rest"] for f in turns[0]["freedoms"]) else None
        angles = [leans(local, steps[turns[0]["freedoms"][-1]["name"]][0]) for local in both if cone]
        spans = [list(itertools.pairwise(proof[key].tolist())) for key in ("parts_a", "parts_b")]
        need([(own[0][0], own[-1][1]) for own in spans] == [(0, len(A)), (0, len(B))], "a triangle is left out")
        known = dict[Any, Any](), dict[Any, Any]()
        rows, codes = deque[Any](itertools.product(*spans, [0])), iter(proof["codes"].tolist())
        while rows:
            row, code = rows.popleft(), next(codes)
            if CUT <= code < 0:
                k, (start, end) = code - CUT, row[min(code - CUT, 1)]
                parts = halves[row[2]] if k == 2 else [(start, (start + end) // 2), ((start + end) // 2, end)]
                rows.extend((*row[:k], part, *row[k + 1 :]) for part in parts)
                continue
            x, y, (box, R, t, is_steady, *moving) = slice(*row[0]), slice(*row[1]), boxes[row[2]]
            if code == OUTSIDE:
                gap = math.inf if any(is_outside(joint, box) for joint, _ in way if joint["cone"] is not None) else 0.0
            elif code == ROUND:
                gap = max(near[0][x].min() - far[1][y].max(), near[1][y].min() - far[0][x].max()) if is_steady else 0.0
            elif code == LEAN:  # a swing changes angles by no more than its own, the twist by none
                need(is_steady and angles, "only a ball keeps angles")
                over = angles[0][0][x].min() - angles[1][1][y], angles[1][0][y] - angles[0][1][x].max()
                gap = max((near[1][y] * np.sin(np.clip(side - cone, 0, np.pi / 2))).min() for side in over)
            else:
                u = (proof["along"][code] if code < proof["of_a"] else R @ proof["along"][code]) / math.hypot(*proof["along"][code])
                for p, q in ((hull(A, row[0], known[0]), hull(B, row[1], known[1])), (A[x].reshape(-1, 3), B[y].reshape(-1, 3))):
                    there = q @ R.T + t
                    gap = (there @ u - motion(u, there, *moving)).min() - (p @ u).max()
                    if gap > claim["clear_mm"]:  # else all corners tell more than those of the box
                        break
            need(gap > claim["clear_mm"], "pieces come too near")

    def boxes(self, way: list[Any], vary: dict[str, Any], proof: dict[str, Any]) -> tuple[list[Any], dict[int, Any]]:
        """Cut a range into boxes; of each return the pose in its middle, and how far what goes together."""
        tied = {f["name"] for joint, _ in way for f in joint["freedoms"]} & set(self.linked) - set(vary)
        drivers, names, todo, found, halves = [n for n in vary if tied and n in self.drivers], list(vary), [vary], [], {}
        (centre, axis), across = proof["about"], plane(proof["about"][1])
        need(len(drivers) <= 1, "two drivers at once")
        for number, (box, cut, place) in enumerate(zip(todo, proof["cuts"].tolist(), proof["at"].tolist(), strict=True)):
            if cut >= 0:
                (low, high), name = box[names[cut]], names[cut]
                need(low < place < high, "a part of the range is left out")
                halves[number] = len(todo), len(todo) + 1
                todo += [{**box, name: (low, place)}, {**box, name: (place, high)}]  # they become more
            values = {name: (sum(ends) / 2, 0.0, (ends[1] - ends[0]) / 2) for name, ends in box.items()}
            for driver in drivers:
                line, half = self.stretch(driver, *box[driver]), values[driver][2]
                values |= {n: (value, rate * half, near) for n, (value, rate, near) in line.items() if n == driver or n not in vary}
            T, steps = self.place(way, {**self.rest, **{name: value for name, (value, *_) in values.items()}})
            w, v, along, aside = map(np.array, zip(*((*steps[name], *values[name][1:]) for name in steps if name in values), strict=True))
            turned, loose = (np.abs(along) + aside) * w.any(1), np.abs(np.cross(w, w[w.any(1).argmax()])).max() > ALIGNED
            off = [(v + np.cross(w, centre)) @ across, np.cross(w, axis), across @ across - across]  # none about one axis or point
            is_steady, outer = max(np.abs(part).max() for part in off) < ROUNDING, loose * (np.cumsum(turned) - turned)
            found.append((box, T[:3, :3], T[:3, 3], is_steady, np.cross(w[:, None], np.eye(3)), v, along, aside, turned, outer))
        return found, halves
