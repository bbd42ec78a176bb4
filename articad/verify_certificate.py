"""Check a motion certificate without trusting it: what `articad verify-certificate` asks.

Written apart from the prover, with NumPy alone. A certificate claims that parts keep apart while joints move within ranges. Beside it
lies how that is seen: how to cut surfaces and ranges, and for each two pieces a direction that separates them. Nothing of that is
believed and nothing is sought here: every inequality is computed anew from meshes and joints, and no piece, range or pair may be missing.

Of each claim rows are visited in the order of a queue, which begins with both whole surfaces over the whole range: each row's code is the
number of a direction that separates the two, or says what to halve; both halves, one after the other, join the queue at its end.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

PROOF = "_proof"  # no part bears such a name
ROUNDING = 1e-9  # of ranges, distances, and what a driver moves
HALF = 0.5  # of entries of a rotation, by which a loop may be open: with a turn of less than 1 rad more it is not half a turn
REST = 1e-4  # rad or mm: by which what follows a driver may be off at rest
OUTSIDE = -4  # code of two pieces in a box outside the cone of a ball; -3, -2, -1 cut the first piece, the second, the box
NOTHING = 2**40  # number of a half of what is not to be cut
ROWS = 4096  # looked at together
SIDES = np.array(list(itertools.product((False, True), repeat=3)))


class Refuted(Exception):  # noqa: N818 - it is no error of the program
    """Says why a certificate proves nothing."""


def need(condition: Any, reason: str) -> None:
    """Refute the certificate unless a condition holds."""
    if not condition:
        raise Refuted(reason)


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return why a certificate file is refuted, nothing if it is accepted; `folder` holds `<part>.npz` of every part, and the proof."""
    try:
        certificate = json.loads(file.read_bytes())
        names = [*certificate["meshes"], PROOF]
        need(all(Path(name).name == name for name in names), "a mesh bears the name of no file")
        left = sorted({found.stem for found in folder.glob("*.npz")} - set(names))
        need(not left, f"it says nothing of {', '.join(left)}")
        Checker(certificate, {name: read(folder / f"{name}.npz") for name in names}).check()
    except Refuted as reason:
        return [str(reason)]
    except Exception as error:  # noqa: BLE001 - what breaks its checker, in whatever way, proves nothing
        return [f"it cannot be read: {error!r}"[:500]]
    return []


def read(file: Path) -> dict[str, Any]:
    """Return the arrays of a file."""
    with file.open("rb") as stream, np.load(stream, allow_pickle=False) as arrays:
        return dict(arrays)


def digest(vertices: Any, triangles: Any) -> str:
    """Return the hash of a mesh as it stands in a certificate."""
    v, f = np.ascontiguousarray(vertices, "<f8"), np.ascontiguousarray(triangles, "<i4")
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


def is_inside(V: Any, F: Any, corners: Any) -> bool:
    """Return whether a connected piece of a mesh lies inside a closed surface that it does not meet (van Oosterom and Strackee)."""
    label = np.arange(len(V))
    while (label[F] != (least := label[F].min(1, keepdims=True))).any():
        np.minimum.at(label, F, least)
    for point in V[np.unique(label[F])]:
        a, b, c = np.moveaxis(corners - point, 1, 0)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        if np.arctan2((a * np.cross(b, c)).sum(1), below).sum() > np.pi:  # half of what a surface winds round a point inside
            return True
    return False


def pieces(corners: Any, order: Any, most: Any) -> tuple[Any, Any, Any]:
    """Return points whose hulls hold the pieces of a surface `(n, 8, 3)`, the two that each is cut into, and the most `(n, k)` of their triangles."""
    need(np.array_equal(np.unique(order), np.arange(len(corners))), "a triangle is left out")
    spans, halves = [(0, len(order))], []
    for start, end in spans:  # they become more
        halves.append((len(spans), len(spans) + 1) if end - start > 1 else (NOTHING, NOTHING))
        spans += [(start, (start + end) // 2), ((start + end) // 2, end)] if end - start > 1 else []
    leaves, ends, single = corners[order], np.array(spans).ravel(), np.array(halves)[:, 0] == NOTHING
    low, high, far = (
        ufunc.reduceat(np.append(each, each[-1:], axis=0), ends)[::2]
        for ufunc, each in ((np.minimum, leaves.min(1)), (np.maximum, leaves.max(1)), (np.maximum, most[order]))
    )
    points = np.where(SIDES, high[:, None], low[:, None])
    points[single] = leaves[ends[::2][single]][:, [0, 1, 2, 2, 2, 2, 2, 2]]
    return points, np.array(halves), far


def joined(ends: Any, rows: list[Any]) -> tuple[Any, Any, Any]:
    """Return pieces of a driver's range in a row as one: value and rate of a line from end to end, and how far from it they are."""
    (value, rate, near), half = (np.array(column) for column in zip(*rows, strict=True)), np.diff(ends)[:, None] / 2
    at = np.stack([value - rate * half, value + rate * half])
    middle, slope = (at[0, 0] + at[1, -1]) / 2, (at[1, -1] - at[0, 0]) / (ends[-1] - ends[0])
    places = np.stack([ends[:-1], ends[1:]]) - (ends[0] + ends[-1]) / 2
    return middle, slope, (np.abs(at - middle - slope * places[..., None]) + near).max((0, 1))


class Checker:
    """A certificate, its meshes and its proof: where parts are, and what follows a driver of loops."""

    def __init__(self, certificate: dict[str, Any], arrays: dict[str, dict[str, Any]]) -> None:
        self.certificate, self.meshes, self.proof = certificate, arrays, arrays[PROOF]
        self.joints = {joint["name"]: joint for joint in certificate["mechanism"]["joints"]}
        self.freedoms = {f["name"]: f for joint in self.joints.values() for f in joint["freedoms"]}
        self.rest: dict[str, float] = {name: f["rest"] for name, f in self.freedoms.items()}
        self.lines = dict[str, dict[Any, Any]]()
        self.linked = [f["name"] for name in certificate["linkage"] for f in self.joints[name]["freedoms"]]
        self.loops = [[*self.way(j["parent"], j["child"]), (j, False)] for j in self.joints.values() if j["loop"]]

    def check(self) -> None:
        """Prove every claim; of what calls itself ok, find what is missing."""
        whole, claims = self.certificate, self.certificate["claims"]
        for name, entry in whole["meshes"].items():
            need(digest(**self.meshes[name]) == entry["sha256"], f"mesh of {name} is missing or another")
        for number, claim in enumerate(claims):
            Claim(self, claim, number).check()
        waived = [set(pair["parts"]) for pair in whole["pairs"] if pair["strength"]["kind"] == "waived"]
        for a, b in itertools.combinations(whole["meshes"] if whole["ok"] else (), 2):
            joints = [joint["name"] for joint, _ in self.way(a, b)]
            free = [{f["name"] for f in self.joints[n]["freedoms"]} for n in joints if n in whole["asked"] and n not in whole["linkage"]]
            drivers = [{name} for name in whole["drivers"] if set(joints) & set(whole["linkage"])]
            both = [one | other for one in free for other in [*free, *drivers] if whole["together"]]
            for names in filter(None, [] if {a, b} in waived else [*free, *drivers, *both]):
                found = any(set(claim["parts"]) == {a, b} and names <= set(claim["vary"]) for claim in claims)
                need(found, f"{a}/{b} over {', '.join(sorted(names))}: no claim, yet the certificate calls itself ok")
        left_out = whole["ok"] and not whole["drivers"] and set(whole["linkage"]) & set(whole["asked"])
        need(not left_out, "nothing drives the loops, yet the certificate calls itself ok")

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
                axis, speed, angle, motion = sign * T[:3, :3] @ f["turn"], sign * T[:3, :3] @ f["slide"], sign * values[f["name"]], np.eye(4)
                steps[f["name"]] = axis, speed + np.cross(T[:3, 3], axis)
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
        _, J, share = self.closure(names, guess, guess)
        A, half = np.linalg.pinv(J[:, 1:], rcond=1e-7), (ends[1] - ends[0]) / 2
        rate, B = np.array([1.0, *(-A @ J[:, 0])]), np.abs(A)
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
        return [driver, *(n for n in self.linked if n != driver and n not in self.certificate["drivers"])]

    def join(self, found: list[Any], names: list[str], ends: Any, guess: Any, wide: Any, other: int) -> None:
        """Add a piece of a driver's range to others if it holds the solution of one that is beside or around it, or at rest."""
        rate, near = self.piece(names, ends, guess, wide)
        span, there, slope, close, apart = found[other]
        at = np.clip(ends.mean(), *span)
        gap = np.abs(guess + rate * (at - ends.mean()) - there - slope * (at - span.mean()))
        same = (gap + near <= apart).all() or (gap + close <= wide).all()  # what one holds is the only solution that the other has
        need(same and ends[0] <= at <= ends[1], f"{names[0]} leaves its branch at {at:.9g}")
        found.append((ends, guess, rate, near, wide))

    def begin(self, names: list[str]) -> list[Any]:
        """Return the rest pose as a piece, about which a solution is no further than `REST`."""
        still, at = np.zeros(len(names)), self.rest[names[0]]
        return [(np.array([at, at]), np.array([self.rest[name] for name in names]), still, np.append(0.0, still[1:] + REST), still)]

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
            ends = [end for end in self.line(driver).get(stops[-1], {}) if end <= high]
            need(ends, f"{driver} is not followed from {stops[-1]:.9g} to {high:.9g}")
            rows.append(self.line(driver)[stops[-1]][max(ends)])
            stops.append(max(ends))
        return dict(zip(self.followers(driver), zip(*joined(np.array(stops), rows), strict=True), strict=True))


class Claim:
    """A statement and its proof."""

    def __init__(self, checker: Checker, claim: dict[str, Any], number: int) -> None:
        self.checker, self.claim, self.vary = checker, claim, claim["vary"]
        self.label = f"{'/'.join(claim['parts'])} over {', '.join(sorted(self.vary))}"
        self.proof = {key: checker.proof[f"{number}.{key}"] for key in ("uses", "cuts", "at", "codes", "along", "kinds")}
        self.way = checker.way(claim["parts"][0], claim["parts"][1], claim["via"])
        tied = {f["name"] for joint, _ in self.way for f in joint["freedoms"]} & set(checker.linked) - set(self.vary)
        drivers = [name for name in self.vary if tied and name in checker.certificate["drivers"]]
        need(len(drivers) <= 1, f"{self.label}: two drivers at once")
        self.driver = drivers[0] if drivers else None

    def check(self) -> None:
        """Prove it."""
        checker, (a, b), (moved, of_a, of_b) = self.checker, self.claim["parts"], self.proof["uses"].tolist()
        whole, (V, F), (there, G) = checker.certificate, *((checker.meshes[n]["vertices"], checker.meshes[n]["triangles"]) for n in (a, b))
        here, (T, _) = V if moved < 0 else V + checker.proof[f"moved.{moved}"], checker.place(self.way, checker.rest)
        least = sum(whole["meshes"][name]["deflection_mm"] for name in (a, b))
        said = [pair["strength"].get("epsilon_mm", 0.0) for pair in whole["pairs"] if {*pair["parts"]} == {a, b}]
        need(self.claim["clear_mm"] >= least - ROUNDING, f"{self.label}: it keeps less than the deflection of the meshes")
        need(self.claim["shrink_mm"] <= max(said) + ROUNDING or not whole["ok"], f"{self.label}: it allows more overlap than it says")
        need(np.linalg.norm(here - V, axis=1).max() <= self.claim["shrink_mm"] + ROUNDING, f"{self.label}: it moves vertices further than it says")
        for name, (low, high) in self.vary.items():
            lower, upper = checker.freedoms[name]["range"]
            need((low < lower + 1e-6 and high > upper - 1e-6) or not whole["ok"], f"{self.label}: not over the whole range of {name}")
            need(low <= checker.rest[name] + ROUNDING and checker.rest[name] <= high + ROUNDING, f"{self.label}: not about the rest pose")
        beside = there @ T[:3, :3].T + T[:3, 3]  # if none is inside the other here, surfaces that never meet keep it so
        need(not is_inside(here, F, beside[G]) and not is_inside(beside, G, here[F]), f"{self.label}: one is inside the other at rest")
        self.cut()
        of, (R, t) = checker.proof, (array[0] for array in self.arrays[:2])
        radii = [np.linalg.norm((points - self.centre) @ self.across, axis=2).max(1) for points in (here[F], there[G] @ R.T + t)]
        height = (there[G] - self.hub) @ self.axle
        spun = np.linalg.norm(there[G] - self.hub - height[..., None] * self.axle, axis=2)
        most = np.stack([radii[1], -height.min(1), height.max(1), spun.max(1)], axis=1)
        self.separate(pieces(here[F], of[f"order.{of_a}"], radii[0][:, None]), pieces(there[G], of[f"order.{of_b}"], most))

    def cut(self) -> None:
        """Cut the range into boxes; of each keep the pose in its middle, and what may move, how far, and together with what."""
        names, checker, cuts = list(self.vary), self.checker, self.proof["cuts"]
        first, rows, boxes, self.halves = self.driver or names[0], [], [dict(self.vary)], np.full((len(cuts), 2), len(cuts))
        for number, (box, cut, at) in enumerate(zip(boxes, cuts, self.proof["at"].tolist(), strict=True)):  # the boxes become more
            middle, half = ({name: (high + sign * low) / 2 for name, (low, high) in box.items()} for sign in (1, -1))
            if cut >= 0:
                (low, high), name = box[names[cut]], names[cut]
                need(low < at < high, f"{self.label}: a part of the range is left out")
                self.halves[number] = len(boxes), len(boxes) + 1
                boxes += [{**box, name: (low, at)}, {**box, name: (at, high)}]
            line = checker.stretch(self.driver, *box[self.driver]) if self.driver else {}
            line = {name: row for name, row in line.items() if name == self.driver or name not in self.vary}
            moves = {name: (0.0, size) for name, size in half.items()} | {n: (rate * half[first], near) for n, (_, rate, near) in line.items()}
            T, steps = checker.place(self.way, {**checker.rest, **middle, **{name: value for name, (value, *_) in line.items()}})
            w, v, along, aside = (np.array(x) for x in zip(*((*steps[n], *moves[n]) for n in steps if n in moves), strict=True))
            spin, flow = (np.concatenate([along[None] @ x, aside[:, None] * x]) for x in (w, v))
            swings = [(joint["cone"], *joint["freedoms"][:2]) for joint, _ in self.way if joint["cone"] is not None]
            tilts = [(cone, *(max(box[f["name"]][0], -box[f["name"]][1], 0.0) for f in fs)) for cone, *fs in swings if fs[0]["name"] in box]
            outside = any(max(x, y) < math.pi / 2 and math.cos(x) * math.cos(y) < math.cos(cone) - ROUNDING for cone, x, y in tilts)
            rows.append((T[:3, :3], T[:3, 3], w, v, np.abs(along) + aside, spin, flow, outside))
        self.arrays = [np.array(column) for column in zip(*rows, strict=True)]
        R, t, w, v = (array[0] for array in self.arrays[:4])
        axes, along = w[w.any(1)], np.where(w.any(1, keepdims=True), w * (w * v).sum(1, keepdims=True), v)
        self.loose = 0.0 if (np.linalg.norm(np.cross(axes, axes[:1]), axis=1) < 1e-12).all() else 1.0  # axes that turn each other
        M, moment = np.concatenate([np.zeros((0, 3)), *(np.cross(np.eye(3), axis).T for axis in axes)]), (v - along)[w.any(1)].ravel()
        self.centre, self.across = np.linalg.lstsq(M, moment)[0], np.eye(3) - sum(axis[:, None] * axis for axis in axes[: 1 - int(self.loose)])
        steady = len(axes) and np.abs(M @ self.centre - moment).max() < ROUNDING and np.abs(along @ self.across).max() < ROUNDING
        turn, flow = w[-1], v[-1]  # what is innermost turns b, which sees its axis stand
        self.axle = turn @ R if turn.any() and abs(turn @ flow) < ROUNDING and not self.driver else np.full(3, np.nan)
        self.hub = (np.cross(turn, flow) - t) @ R
        self.across = self.across if steady else np.full((3, 3), np.nan)  # radii about the one axis or point of all turns

    def motion(self, box: Any, u: Any, p: Any, spun: Any, size: Any) -> Any:
        """Bound how far what is within `size` of points `(n, k, 3)` goes along directions `(n, 3)` in boxes, `(n, k)`.

        That is their speed, and half the second derivative: along u the factor i outside j turns what j moves by |u x axis i|. To what is
        `spun` the innermost turn does nothing.
        """
        w, v, width, spin, flow = (array[box] for array in self.arrays[2:7])
        width[spun, -1], spin[spun, -1], flow[spun, -1] = 0.0, 0.0, 0.0
        moved = np.abs(p @ np.cross(u[:, None], spin).transpose(0, 2, 1) + (flow @ u[..., None])[:, None, :, 0]).sum(2)
        moved += (size * np.linalg.norm(np.cross(u[:, None], spin), axis=2).sum(1))[:, None]
        speed = np.linalg.norm(np.cross(w[:, None], p[:, :, None]) + v[:, None], axis=3) + size[:, None, None]
        turns = w.any(2) * 1.0
        tilt = np.linalg.norm(np.cross(u[:, None], w), axis=2) + self.loose * (np.cumsum(turns * width, axis=1) - turns * width)
        tilt = np.minimum(tilt, 1.0) * turns * width
        outside, inside = np.cumsum(tilt, axis=1) - tilt, 0.0
        for f in range(width.shape[1] - 1, -1, -1):
            carried = width[:, f, None] * (speed[..., f] + inside * turns[:, f, None])
            moved, inside = moved + carried * (tilt / 2 + outside)[:, f, None], inside + carried
        return moved

    def separate(self, a: tuple[Any, ...], b: tuple[Any, ...]) -> None:
        """Follow how pieces of both and boxes were cut, until a direction separates each two of them."""
        (A, halves_a, far_a), (B, halves_b, most), (R, t, w, *_, outside) = a, b, self.arrays
        S = self.hub + (most[:, [1, 2] * 4] * ([-1, 1] * 4))[..., None] * self.axle  # ends of the axis beside a piece of b
        codes, rows = self.proof["codes"], np.zeros((1, 3), int)
        while len(rows):
            code, codes = codes[: len(rows)], codes[len(rows) :]
            need(len(code) == len(rows) and code.min() >= OUTSIDE and outside[rows[code == OUTSIDE, 2]].all(), f"{self.label}: it ends too early")
            settled = np.flatnonzero(code >= 0)
            for some in np.array_split(settled, len(settled) // ROWS + 1):
                (x, y, box), u = rows[some].T, self.proof["along"][code[some]]
                kind = np.searchsorted(self.proof["kinds"], code[some], side="right")[:, None]  # of a, of b, round with a outside, with b, spun
                u = np.where(kind % 2, (R[box] @ u[..., None])[..., 0], u)
                u = u / np.linalg.norm(u, axis=1, keepdims=True)
                spun, size = kind[:, 0] == 4, np.where(kind[:, 0] == 4, most[y, 3], 0.0)
                p, q = A[x], np.where(spun[:, None, None], S[y], B[y]) @ R[box].transpose(0, 2, 1) + t[box][:, None]
                gap = ((q @ u[..., None])[..., 0] - self.motion(box, u, q, spun, size)).min(1) - (p @ u[..., None])[..., 0].max(1)
                gap -= size * np.linalg.norm(np.cross(u, w[box, -1]), axis=1)
                outer = np.where(kind[..., None] == 3, q, p) - self.centre
                beyond = (outer @ (u @ self.across)[..., None])[..., 0].min(1) - np.where(kind[:, 0] == 3, far_a[x, 0], most[y, 0])
                need((np.where(kind[:, 0] % 4 < 2, gap, beyond) > self.claim["clear_mm"]).all(), f"{self.label}: pieces come too near")
            cut = (code < 0) & (code > OUTSIDE)
            which, rows = np.repeat(code[cut] + 3, 2), np.repeat(rows[cut], 2, axis=0)
            for column, numbers in enumerate((halves_a, halves_b, self.halves)):
                mine = which == column
                rows[mine, column] = numbers[rows[mine, column][::2]].ravel()
