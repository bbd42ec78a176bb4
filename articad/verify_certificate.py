"""Check a motion certificate without trusting it: what `articad verify-certificate` asks.

Written apart from the prover, with NumPy and python-fcl only. A certificate holds statements: these parts keep apart while these
joints move within these ranges. Each is proven here anew from the meshes and the joints, and none may be missing.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from pathlib import Path
from typing import Any

import fcl
import numpy as np

ROUNDING = 1e-9  # of ranges, distances and angles
STILL_MM = 1e-7  # motion within a box so small that what is not apart touches
REST = 1e-4  # rad or mm: by which what follows may be off at rest
CHUNK = 4096  # pairs of pieces looked at together
MOST_PAIRS = 40_000_000  # of pieces looked at for one claim


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return why a certificate file is refuted, nothing if it is accepted; `folder` holds `<part>.npz` of every part."""
    certificate = json.loads(file.read_text())
    found = {name: np.load(folder / f"{name}.npz", allow_pickle=False) for name in certificate["meshes"]}
    return verify(certificate, {name: (arrays["vertices"], arrays["triangles"]) for name, arrays in found.items()})


def verify(certificate: dict[str, Any], meshes: dict[str, tuple[Any, Any]]) -> list[str]:
    """Return why the certificate is refuted, nothing if it is accepted; `meshes`: vertices (V, 3), triangles (T, 3) by part."""
    try:
        return _faults(certificate, meshes)
    except (LookupError, TypeError, ValueError, ArithmeticError) as error:
        return [f"it does not hold together: {error!r}"]


def _faults(certificate: dict[str, Any], meshes: dict[str, tuple[Any, Any]]) -> list[str]:
    entries, mechanism = certificate["meshes"], Mechanism(certificate)
    found = [f"mesh of {name} is missing or another" for name in entries if digest(meshes.get(name)) != entries[name]["sha256"]]
    for claim in [] if found else certificate["claims"]:
        try:
            fault = Claim(certificate, mechanism, meshes, claim).fault()
        except ValueError as error:
            fault = str(error)
        found += [f"{'/'.join(claim['parts'])} over {', '.join(sorted(claim['vary']))}: {fault}"] * bool(fault)
    waived = [set(pair["parts"]) for pair in certificate["pairs"] if pair["strength"]["kind"] == "waived"]
    for a, b in itertools.combinations(entries if certificate["ok"] else (), 2):
        mine = [claim for claim in certificate["claims"] if set(claim["parts"]) == {a, b}]
        missing = [] if {a, b} in waived else [names for names in mechanism.sets(a, b) if not any(mechanism.covers(c, names) for c in mine)]
        found += [f"{a}/{b} over {', '.join(sorted(names))}: no claim, yet the certificate calls itself ok" for names in missing]
    return found


def digest(mesh: tuple[Any, Any] | None) -> str:
    """Return the hash of a mesh as it stands in a certificate."""
    v, f = (np.ascontiguousarray(array, dtype) for array, dtype in zip(mesh or ([], []), ("<f8", "<i4"), strict=True))
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


def hat(w: Any) -> Any:
    """Return the matrix of w x."""
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def screw(turn: Any, slide: Any) -> Any:
    """Return the turn about a vector by its length and the slide, `(4, 4)` (Rodrigues)."""
    T, angle = np.eye(4), math.hypot(*turn)
    K = hat(np.divide(turn, angle or 1.0))
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    T[:3, 3] = slide
    return T


class Mechanism:
    """Joints, ways between parts, and what follows a driver."""

    def __init__(self, certificate: dict[str, Any]) -> None:
        self.certificate, self.joints = certificate, {joint["name"]: joint for joint in certificate["mechanism"]["joints"]}
        self.freedoms = {f["name"]: f for joint in self.joints.values() for f in joint["freedoms"]}
        self.linkage, self.known = set(certificate["linkage"]), dict[Any, list[Any]]()
        self.frames = {name: (np.array(j["parent_frame"]), np.linalg.inv(j["child_frame"])) for name, j in self.joints.items()}
        self.loops = [[*self.way(j["parent"], j["child"]), (j, False)] for j in self.joints.values() if j["loop"]]

    def way(self, a: str, b: str, names: Any = None) -> list[Any]:
        """Return the joints from a to b, each with whether it is crossed from parent to child: those named, or of the tree."""
        ways: dict[str, list[Any]] = {a: []}
        for part in (todo := [a]):
            for joint in self.joints.values():
                for near, far, forward in ((joint["parent"], joint["child"], True), (joint["child"], joint["parent"], False)):
                    allowed = not joint["loop"] if names is None else joint["name"] in names
                    if near == part and far not in ways and allowed:
                        ways[far] = [*ways[part], (joint, forward)]
                        todo.append(far)
        if b not in ways:
            raise ValueError(f"no joints lead from {a} to {b}")
        return ways[b]

    def sets(self, a: str, b: str) -> list[set[str]]:
        """Return the sets of coordinates over which two parts are to be proven apart."""
        names, together = [joint["name"] for joint, _ in self.way(a, b)], self.certificate["together"]
        tied, drivers = self.linkage & set(names), [{name} for name in self.certificate["drivers"]]
        moving = [{f["name"] for f in self.joints[n]["freedoms"]} for n in names if n in self.certificate["asked"] and n not in tied]
        both = [*itertools.combinations(moving, 2), *(itertools.product(drivers, moving) if tied else ())]
        return [names for names in [*moving, *(drivers if tied else ()), *(x | y for x, y in both if together)] if names]

    def covers(self, claim: dict[str, Any], names: set[str]) -> bool:
        """Return whether a claim varies these coordinates; one on whatever a linkage does covers all its drivers."""
        tied = {f["name"] for name in claim["via"] if name in self.linkage for f in self.joints[name]["freedoms"]}
        return names - (set(self.certificate["drivers"]) if tied <= set(claim["vary"]) else set()) <= set(claim["vary"])

    def place(self, way: list[Any], values: dict[str, float], *, single: bool) -> tuple[Any, list[Any]]:
        """Return T_a_b and each step on the way: its freedoms, axis, moment and frame as a sees them; `single`: a ball as three turns."""
        T, steps = np.eye(4), []
        for joint, forward in way:
            (L, R), sign = self.frames[joint["name"]], 1.0 if forward else -1.0
            groups = [list(g) for _, g in itertools.groupby(joint["freedoms"], lambda f: f["name"] if single else f["step"])]
            T = T @ (L if forward else np.linalg.inv(R))
            for group in groups[:: int(sign)]:
                turn, slide = (sum(np.array(f[key]) * values[f["name"]] for f in group) for key in ("turn", "slide"))
                w, o = sign * T[:3, :3] @ group[0]["turn"], T[:3, 3]
                v = sign * T[:3, :3] @ group[0]["slide"] + hat(o) @ w
                steps.append((group, w, v, T) if len(group) == 1 else (group, 0 * w, o, T))
                T = T @ screw(sign * turn, sign * slide)
            T = T @ (R if forward else np.linalg.inv(L))
        return T, steps

    def closure(self, values: dict[str, float], names: list[str]) -> tuple[Any, Any, list[Any]]:
        """Return the loops' and couplings' residuals, their Jacobian, and of each row the joints in it and its curvature."""
        r, J, rows = [], [], []
        for way in self.loops:
            T, steps = self.place(way, values, single=True)
            columns = {group[0]["name"]: np.concatenate([v + hat(w) @ T[:3, 3], w]) for group, w, v, _ in steps}
            r += [*T[:3, 3], *((T[[2, 0, 1], [1, 2, 0]] - T[[1, 2, 0], [2, 0, 1]]) / 2)]
            J += np.transpose([columns.get(name, np.zeros(6)) for name in names]).tolist()
            length: Any = sum(np.linalg.norm(np.array(j[key])[:3, 3]) for j, _ in way for key in ("parent_frame", "child_frame"))
            length += sum(abs(values[name]) for name in columns if any(self.freedoms[name]["slide"]))
            rows += [(set(columns), length)] * 3 + [(set(columns), 1.0)] * 3
        for c in self.certificate["mechanism"]["couplings"]:
            r.append(values[c["b"]] - c["ratio"] * values[c["a"]] - c["offset"])
            J.append([float(name == c["b"]) - c["ratio"] * (name == c["a"]) for name in names])
            rows.append((set(), 0.0))
        return np.array(r), np.array(J), rows

    def solve(self, values: dict[str, float], names: list[str]) -> tuple[Any, ...]:
        """Close the loops while the first of the coordinates stands; return values, residuals, Jacobian, its left inverse and rows."""
        for _ in range(8):
            r, J, rows = self.closure(values, names)
            A = np.linalg.pinv(J[:, 1:], rcond=1e-7)
            if np.abs(A @ r).max() < 1e-13:
                break
            values = {**values, **dict(zip(names[1:], np.array([values[n] for n in names[1:]]) - A @ r, strict=True))}
        return values, r, J, A, rows

    def piece(self, driver: str, guess: dict[str, float], middle: float, half: float) -> Any:
        """Return a piece of a driver's range if near its line there is one solution only (Brouwer, Banach), else None.

        It holds the middle, the half length, the values at the middle, and of each coordinate its rate and distance from the line.
        """
        names = [driver, *(f["name"] for n in sorted(self.linkage) for f in self.joints[n]["freedoms"] if f["name"] != driver)]
        values, r, J, A, rows = self.solve({**guess, driver: middle}, names)
        rate, size = np.array([1.0, *(-A @ J[:, 0])]), max([length for _, length in rows], default=0.0) + 1.0
        weight = np.array([1.0 if any(self.freedoms[n]["turn"]) else 1.0 / size for n in names])  # slides count as turns of far points
        member = np.array([[n in mine for n in names] for mine, _ in rows]) * weight
        tube, curved = np.zeros(len(names)), np.array([length + 2 * half * (length > 1.0) for _, length in rows])
        for grow in (2.0, 1.5, 1.2):
            residual = np.abs(A @ r) + np.abs(A) @ (curved * (member @ (np.abs(rate) * half + tube)) ** 2) / 2
            tube[1:] = grow * residual + ROUNDING
        reach = member @ (np.abs(rate) * half + tube)
        inside = np.abs(A @ r) + np.abs(A) @ (curved * reach**2) / 2 <= tube[1:]
        inside &= (np.abs(A) @ (curved * reach * (member @ tube)) < tube[1:]) & (np.abs(A @ J[:, 1:] - np.eye(len(A))).sum(1) < ROUNDING)
        return (middle, half, values, dict(zip(names, zip(rate, tube, strict=True), strict=True))) if inside.all() else None

    def near(self, piece: Any, values: dict[str, float], driver: str) -> bool:
        """Return whether values are the solution on a piece."""
        middle, _, centre, line = piece
        return all(abs(values[n] - centre[n] - rate * (values[driver] - middle)) <= tube + ROUNDING for n, (rate, tube) in line.items())

    def halves(self, driver: str, piece: Any) -> list[Any]:
        """Return a piece in two, each about the solution that the whole one holds."""
        middle, half, values, line = piece
        found = []
        for at in (middle - half / 2, middle + half / 2):
            part = self.piece(driver, {n: v + line.get(n, (0.0, 0.0))[0] * (at - middle) for n, v in values.items()}, at, half / 2)
            if part is None or not self.near(piece, part[2], driver):
                raise ValueError(f"{driver} leaves its branch at {at:.9g}")
            found.append(part)
        return found

    def pieces(self, driver: str, end: float) -> list[Any]:
        """Return pieces of a driver's range from rest to an end, each with the solution of the last one where they meet."""
        if (driver, end) in self.known:
            return self.known[driver, end]
        values, found = {name: f["rest"] for name, f in self.freedoms.items()}, list[Any]()
        at, step, names = (
            values[driver],
            (end - values[driver]) / 8,
            [driver, *(n for n in values if self.freedoms[n]["joint"] in self.linkage and n != driver)],
        )
        rest, values = values, self.solve(values, names)[0]
        if any(abs(values[n] - rest[n]) > REST for n in names):
            raise ValueError("the loops do not close at rest")
        while abs(end - at) > ROUNDING:
            there = end if abs(end - at) <= abs(step) else at + step
            piece = self.piece(driver, values, (at + there) / 2, abs(there - at) / 2)
            if piece is None or not self.near(piece, values, driver):
                step /= 2
                if abs(step) < 1e-6:
                    raise ValueError(f"{driver} cannot be followed beyond {at:.9g}")
                continue
            found, at, step = [*found, piece], there, step * 1.5
            values = self.solve({n: v + piece[3].get(n, (0.0, 0.0))[0] * (there - piece[0]) for n, v in piece[2].items()}, names)[0]
            if not self.near(piece, values, driver):
                raise ValueError(f"{driver} leaves its branch at {at:.9g}")
        self.known[driver, end] = found
        return found


class Tree:
    """Boxes over things with lower and upper ends `(T, k)`, halved along their longest side; node n has children 2n + 1 and 2n + 2."""

    def __init__(self, low: Any, high: Any) -> None:
        levels = max(len(low) - 1, 0).bit_length()
        order, middle, rows = np.minimum(np.arange(2**levels), len(low) - 1)[None], (low + high) / 2, []
        for level in range(levels + 1):
            rows.append((low[order].min(1), high[order].max(1)))
            if level < levels:
                along = np.take_along_axis(middle[order], np.argmax(np.ptp(middle[order], axis=1), axis=1)[:, None, None], axis=2)[..., 0]
                order = np.take_along_axis(order, np.argsort(along, axis=1), axis=1).reshape(2 * len(order), -1)
        (self.low, self.high), self.order = (np.concatenate(ends) for ends in zip(*rows, strict=True)), order[:, 0]
        self.first, self.size = len(self.low) - len(self.order), np.linalg.norm(self.high - self.low, axis=1)  # of the leaves; of all


class Surface(Tree):
    """Triangles `(T, 3, 3)` with boxes over them."""

    def __init__(self, corners: Any) -> None:
        super().__init__(corners.min(1), corners.max(1))
        self.corners, self.sides = corners, np.array(list(itertools.product((0, 1), repeat=3)))

    def points(self, nodes: Any, *, leaf: bool) -> Any:
        """Return the corners of the triangles, or of the boxes, `(n, 3 or 8, 3)`."""
        if leaf:
            return self.corners[self.order[nodes - self.first]]
        return np.where(self.sides, self.high[nodes][:, None], self.low[nodes][:, None])


def normal(t: Any) -> Any:
    """Return unit normals of triangles `(n, 3, 3)`."""
    n = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    return n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)


def across(p: Any, q: Any) -> Any:
    """Return the unit direction between the nearest edges of triangles `(n, 3, 3)` each."""
    d, e, between = (np.roll(p, -1, 1) - p)[:, :, None], (np.roll(q, -1, 1) - q)[:, None], p[:, :, None] - q[:, None]
    a, f, b, c, g = ((x * y).sum(3) for x, y in ((d, d), (e, e), (d, e), (d, between), (e, between)))
    below = a * f - b * b
    s = np.clip((b * g - c * f) / np.where(below > 1e-12 * a * f, below, np.inf), 0, 1)
    t = np.clip((b * s + g) / np.maximum(f, 1e-300), 0, 1)
    s = np.clip((b * t - c) / np.maximum(a, 1e-300), 0, 1)
    v = (t[..., None] * e - s[..., None] * d - between).reshape(-1, 9, 3)
    v = v[np.arange(len(v)), np.argmin((v * v).sum(2), axis=1)]
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-300)


def winding(point: Any, corners: Any) -> float:
    """Return how often a closed surface winds round a point (van Oosterom and Strackee)."""
    a, b, c = np.moveaxis(corners - point, 1, 0)
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(np.arctan2((a * np.cross(b, c)).sum(1), below).sum() / (2 * np.pi))


def shells(corners: Any) -> list[Any]:
    """Return a point of each connected piece."""
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    label, triangles = np.arange(len(points)), index.reshape(-1, 3)
    while (label[triangles] != (least := label[triangles].min(1)[:, None])).any():
        np.minimum.at(label, triangles, least)
    return [points[k] for k in np.unique(label[triangles])]


def inwards(V: Any, F: Any, depth: float) -> Any:
    """Return vertices moved by `depth`: any direction would do for the proof, this is the one that the prover took."""
    corners, total = V[F], np.zeros_like(V)
    unit = normal(corners)
    for k in range(3):
        u, v = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        np.add.at(total, F[:, k], unit * np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))[:, None])
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return V - depth * total / np.where(size > 0, size, 1)


def outline(corners: Any, frame: Any, joint: dict[str, Any], swing: tuple[float, float]) -> tuple[Any, Any]:
    """Return lower and upper ends of triangles in coordinates that a joint keeps: radius, height, sides, angle from a ball's axis."""
    ball, turns = joint["cone"] is not None, any(any(f["turn"]) for f in joint["freedoms"])
    local = (corners - frame[:3, 3]) @ frame[:3, :3]
    flat = local * ([1, 1, 1] if ball else [1, 1, 0])
    edge, n = np.roll(flat, -1, 1) - flat, normal(flat)
    t = np.clip(-(flat * edge).sum(2) / np.maximum((edge * edge).sum(2), 1e-300), 0, 1)
    within = (np.einsum("tki,tki->tk", np.cross(n[:, None], edge), -flat) >= 0).all(1) & n.any(1)
    least = np.minimum(np.linalg.norm(flat + t[..., None] * edge, axis=2).min(1), np.where(within, np.abs((n * flat[:, 0]).sum(1)), np.inf))
    low, high = [least], [np.linalg.norm(flat, axis=2).max(1)]
    for k in () if ball else (2,) if turns else (0, 1, 2):
        low.append(local[..., k].min(1))
        high.append(local[..., k].max(1))
    if ball:
        size, middle = np.linalg.norm(local, axis=2), local.mean(1)
        length = np.maximum(np.linalg.norm(middle, axis=1), 1e-300)
        spread = np.arccos(np.clip((local * middle[:, None]).sum(2) / np.maximum(size * length[:, None], 1e-300), -1, 1)).max(1)
        wide = spread + swing[0] + np.arcsin(np.clip(swing[1] / np.maximum(least, 1e-300), 0, 1)) + 1e-7
        wide = np.where((spread < np.pi / 2) & (least > swing[1]), wide, np.pi)
        angle = np.arccos(np.clip(middle[:, 2] / length, -1, 1))
        low.append(angle - wide)
        high.append(angle + wide)
    return np.stack(low, 1), np.stack(high, 1)


def meeting(a: tuple[Any, Any], b: tuple[Any, Any], needed: Any) -> Any:
    """Return which of the boxes a `(T, k)` are within `needed` of any of b."""
    met, tree = np.zeros(len(a[0]), dtype=bool), Tree(*a) if len(a[0]) else None
    for rows in np.array_split(tree.order, len(tree.order) // 64 + 1) if tree and len(b[0]) else []:
        near = ((b[0] <= a[1][rows].max(0) + needed) & (b[1] >= a[0][rows].min(0) - needed)).all(1)
        met[rows] |= ((b[0][near] <= a[1][rows][:, None] + needed) & (b[1][near] >= a[0][rows][:, None] - needed)).all(2).any(1)
    return met


class Claim:
    """One statement to be proven."""

    def __init__(self, certificate: dict[str, Any], mechanism: Mechanism, meshes: dict[str, Any], claim: dict[str, Any]) -> None:
        self.certificate, self.mechanism, self.claim, self.vary = certificate, mechanism, claim, claim["vary"]
        self.driver: Any = None
        self.way = mechanism.way(claim["parts"][0], claim["parts"][1], claim["via"])
        self.freedoms = [f for joint, _ in self.way for f in joint["freedoms"]]
        tied = [f["name"] for f in self.freedoms if f["name"] not in {**self.vary, **claim["hold"]}]
        if tied:
            self.driver = next((n for n in self.vary if n in certificate["drivers"]), None)
        self.own = [n for n in self.vary if n != self.driver]
        (self.V, self.F), (V, F) = (meshes[name] for name in claim["parts"])
        self.models: Any = None
        self.corners_b, self.boxes, self.rows = V[F], list[Any](), list[Any]()

    def fault(self) -> str:  # noqa: PLR0911  one reason after the other
        """Return why the claim is refused, or nothing."""
        claim, vary = self.claim, self.vary
        if {f["name"] for f in self.freedoms} - {*vary, *claim["hold"]} and self.driver is None:
            return "not all that moves between the two is named"
        rest = {name: f["rest"] for name, f in self.mechanism.freedoms.items()}
        if any(abs(value - rest[name]) > ROUNDING for name, value in claim["hold"].items()):
            return "what is held does not stand at rest"
        for name, (low, high) in vary.items() if self.certificate["ok"] else ():
            least, most = self.mechanism.freedoms[name]["range"]
            if low > least + 1e-6 or high < most - 1e-6:
                return f"{name} is varied over [{low:.6g}, {high:.6g}] only"
        entries = [pair["strength"] for pair in self.certificate["pairs"] if set(pair["parts"]) == set(claim["parts"])]
        allowed = max([entry.get("epsilon_mm", 0.0) for entry in entries], default=0.0)
        if self.certificate["ok"] and claim["shrink_mm"] > allowed + ROUNDING:
            return f"it allows an overlap of {claim['shrink_mm']:.6g} mm, more than it says"
        if claim["clear_mm"] < sum(self.certificate["meshes"][name]["deflection_mm"] for name in claim["parts"]) - ROUNDING:
            return f"a distance of {claim['clear_mm']:.6g} mm is less than the deflection of the meshes"
        corners = self.moved()
        T, _ = self.mechanism.place(self.way, rest, single=False)
        both = corners, self.corners_b @ T[:3, :3].T + T[:3, 3]
        if any(winding(point, other) > 0.5 for one, other in (both, both[::-1]) for point in shells(one)):
            return "one part is inside the other at the start"  # if not, surfaces that never meet keep it so
        return self.apart(*self.facing(corners))

    def moved(self) -> Any:
        """Return the first part's triangles, their vertices moved inwards: all of them, or those near the axis of the joint."""
        V, within = inwards(self.V, self.F, self.claim["shrink_mm"]), self.claim["within_mm"]
        if within is not None:
            rest = {name: f["rest"] for name, f in self.mechanism.freedoms.items()}
            found = [(s[3], len(s[0]) > 1) for s in self.mechanism.place(self.way, rest, single=False)[1] if s[0][0]["name"] in self.vary]
            frame, ball = found[0] if found else (np.eye(4), True)
            local = (self.V - frame[:3, 3]) @ frame[:3, : 3 if ball else 2]
            V = np.where(np.linalg.norm(local, axis=1, keepdims=True) <= within, V, self.V)
        return V[self.F]

    def facing(self, a: Any) -> tuple[Any, Any]:
        """Return the triangles of both parts that a joint about one axis or point could bring together, if it is the only one."""
        rest, b = {name: f["rest"] for name, f in self.mechanism.freedoms.items()}, self.corners_b
        moving = [(joint, forward) for joint, forward in self.way if any(f["name"] not in self.claim["hold"] for f in joint["freedoms"])]
        if len(moving) != 1 or moving[0][0]["type"] in ("planar", "universal"):
            return a, b
        joint = moving[0][0]
        zero = {**rest, **{f["name"]: 0.0 for f in joint["freedoms"]}}
        T, steps = self.mechanism.place(self.way, zero, single=False)
        frame = next(frame for group, _, _, frame in steps if group[0]["joint"] == joint["name"])
        cone, needed = joint["cone"] or 0.0, self.claim["clear_mm"]
        mine, theirs = outline(a, frame, joint, (0.0, 0.0)), outline(b @ T[:3, :3].T + T[:3, 3], frame, joint, (cone, needed))
        if joint["cone"] is None:
            slides: Any = sum(np.sort(np.multiply(f["range"], f["slide"][2])) for f in joint["freedoms"])
            theirs[0][:, 1 if len(theirs[0][0]) < 3 else 3] -= max(slides[1], -slides[0])
            theirs[1][:, 1 if len(theirs[0][0]) < 3 else 3] += max(slides[1], -slides[0])
        return a[meeting(mine, theirs, needed)], b[meeting(theirs, mine, needed)]

    def add(self, boxes: list[Any]) -> Any:
        """Add boxes: values of all coordinates, half ranges of those that move, and a piece of the driver's range or None."""
        first = len(self.boxes)
        for values, half, piece in boxes:
            line = piece[3] if piece else {}
            T, steps = self.mechanism.place(self.way, values, single=self.driver is not None)
            steps = [step for step in steps if step[0][0]["name"] in {**half, **line}]
            self.groups = [group for group, *_ in steps]
            w, m = (np.array([step[k] for step in steps]) for k in (1, 2))
            speed = np.array([line[g[0]["name"]][0] * piece[1] if g[0]["name"] in line else 0.0 for g in self.groups])
            aside = np.array([math.hypot(*(half[f["name"]] if f["name"] in half else line[f["name"]][1] for f in g)) for g in self.groups])
            own = aside * [len(g) == 1 for g in self.groups]
            spin, flow = (np.concatenate([(speed @ x)[None], x * own[:, None]]) for x in (w, m))
            self.boxes.append((values, half, piece))
            self.rows.append((T, w, m, np.abs(speed) + aside, spin, flow))
        self.arrays = tuple(np.array(x) for x in zip(*self.rows, strict=True))
        return np.arange(first, len(self.boxes))

    def motion(self, box: Any, u: Any, p: Any) -> tuple[Any, Any]:
        """Bound how far points `(n, k, 3)` go along directions `(n, D, 3)` in boxes: what each coordinate adds, and all together.

        To first order their speed, to second order |u x axis| times the speed that each factor inside gives (see `Certificate`).
        """
        _, w, m, width, spin, flow = (array[box][:, None] for array in self.arrays)
        turns = np.array([float(any(f["turn"][k] for f in g for k in range(3))) for g in self.groups])
        swing = np.array([len(g) > 1 for g in self.groups])
        first = np.abs(np.einsum("ndc,nkgc->ndkg", u, np.cross(spin, p[:, :, None]) + flow))
        arm = p[:, :, None] - m
        first[..., 1:] += np.linalg.norm(np.cross(arm[:, None], u[:, :, None, None]), axis=-1) * width[:, None] * swing
        speed = np.where(swing, np.linalg.norm(arm, axis=-1), np.linalg.norm(np.cross(w, p[:, :, None]) + m, axis=-1))
        turned = (width * turns)[:, 0]
        tilt = np.minimum(np.linalg.norm(np.cross(u[:, :, None], w), axis=-1) + swing, 1.0)
        if not self.parallel:  # an axis is turned by the factors outside it
            tilt = np.minimum(tilt + (np.cumsum(turned, axis=1) - turned)[:, None], 1.0)
        tilt *= turned[:, None]
        outside, inside, second = np.cumsum(tilt, axis=2) - tilt, 0.0, 0.0
        for f in range(len(self.groups) - 1, -1, -1):
            carried = width[..., f] * (speed[..., f] + inside * turns[f])
            second = second + carried[:, None] * (tilt[..., f] + 2 * outside[..., f])[..., None] / 2
            inside = inside + carried
        return first, first.sum(-1) + second

    def apart(self, corners_a: Any, corners_b: Any) -> str:  # noqa: C901, PLR0912  one search, to be read from top to bottom
        """Keep two surfaces apart over the whole range: cut pieces, or the range where their motion is what matters."""
        if not len(corners_a) or not len(corners_b):
            return ""
        a, b, needed, looked = Surface(corners_a), Surface(corners_b), self.claim["clear_mm"], 0
        roots = self.roots()
        for root in roots.tolist():  # what is wrong by much is found at once
            if reason := self.refuted(root):
                return reason
        stack, cut = list[Any]([(0 * roots, 0 * roots, roots)]), dict[int, Any]()
        while stack:
            i, j, k = stack.pop()
            if len(i) > CHUNK:
                stack.append((i[:-CHUNK], j[:-CHUNK], k[:-CHUNK]))
                i, j, k = i[-CHUNK:], j[-CHUNK:], k[-CHUNK:]
            if (looked := looked + len(i)) > MOST_PAIRS:
                return "it takes too long to be proven"
            single = (i >= a.first) & (j >= b.first)
            for leaf in (False, True):
                rows = np.flatnonzero(single == leaf)
                if not len(rows):
                    continue
                x, y, box = i[rows], j[rows], k[rows]
                T = self.arrays[0][box]
                R = T[:, :3, :3]
                p, q = a.points(x, leaf=leaf), b.points(y, leaf=leaf) @ R.transpose(0, 2, 1) + T[:, None, :3, 3]
                toward = across(p, q) if leaf else q.mean(1) - p.mean(1)
                toward /= np.maximum(np.linalg.norm(toward, axis=1, keepdims=True), 1e-300)
                base = [normal(p)[:, None], normal(q)[:, None]] if leaf else [np.broadcast_to(np.eye(3), R.shape), R.transpose(0, 2, 1)]
                u = np.concatenate([*base, toward[:, None]], axis=1)
                mine, theirs = u @ p.transpose(0, 2, 1), u @ q.transpose(0, 2, 1)
                sign = np.where(theirs.min(2) - mine.max(2) >= mine.min(2) - theirs.max(2), 1.0, -1.0)[..., None]
                shares, moved = self.motion(box, u, q)
                still = (sign * theirs).min(2) - (sign * mine).max(2)
                left = ((sign * theirs - moved).min(2) - (sign * mine).max(2)).max(1) <= needed
                x, y, box, best = x[left], y[left], box[left], np.argmax(still[left], axis=1)
                at, most = np.arange(len(x)), moved[left].max(2)
                if leaf and len(x) and (most.max(1) < STILL_MM).any():
                    return self.refuted(int(box[np.argmax(most.max(1) < STILL_MM)])) or "surfaces are not proven apart"
                thick = (np.ptp(mine, axis=2) + np.ptp(theirs, axis=2))[left][at, best] / 2
                split = np.full(len(x), leaf) | (most[at, best] > thick)
                for number in np.unique(box[split]):
                    if number not in cut:
                        cut[number] = self.cut(
                            int(number), shares[left][box == number].max(2)[np.arange((box == number).sum()), best[box == number]].sum(0)
                        )
                if split.any():
                    halves = np.array([(cut[n] + [-1, -1])[:2] for n in box[split].tolist()])
                    stack += [(x[split][ok], y[split][ok], n[ok]) for n in halves.T for ok in [n >= 0]]
                x, y, box = x[~split], y[~split], box[~split]
                wide = (x < a.first) & ((y >= b.first) | (a.size[x] >= b.size[y]))
                for one, other, flip in ((x[wide], y[wide], False), (y[~wide], x[~wide], True)):
                    children: Any = np.concatenate([2 * one + 1, 2 * one + 2]), np.tile(other, 2)
                    stack.append((*children[:: -1 if flip else 1], np.tile(box[~wide if flip else wide], 2)))
        return ""

    def roots(self) -> Any:
        """Add boxes that cover the whole range."""
        rest = {name: f["rest"] for name, f in self.mechanism.freedoms.items()}
        middle = {n: sum(self.vary[n]) / 2 for n in self.own}
        half = {n: (self.vary[n][1] - self.vary[n][0]) / 2 for n in self.own}
        pieces = [None] if self.driver is None else [p for end in self.vary[self.driver] for p in self.mechanism.pieces(self.driver, end)]
        found = self.add([({**(rest if piece is None else piece[2]), **self.claim["hold"], **middle}, half, piece) for piece in pieces])
        axes = [w for group, w in zip(self.groups, self.rows[0][1], strict=True) if any(any(f["turn"]) for f in group)]
        self.parallel = all(len(g) == 1 for g in self.groups) and all(np.linalg.norm(np.cross(w, axes[0])) < 1e-12 for w in axes)
        return found

    def cut(self, number: int, shares: Any) -> list[int]:
        """Halve a box across the coordinate that has the largest share of the motion."""
        values, half, piece = self.boxes[number]
        own = {n: sum(shares[1 + k] for k, g in enumerate(self.groups) if n in [f["name"] for f in g]) for n in half}
        name = max(own, key=lambda n: (own[n], half[n]), default=None)
        if name is None or own[name] < shares.sum() - sum(own.values()):
            found = [
                ({**values, **{n: v for n, v in part[2].items() if n not in half and n not in self.claim["hold"]}}, half, part)
                for part in self.mechanism.halves(self.driver, piece)
            ]
        else:
            name = max([f["name"] for g in self.groups if name in [f["name"] for f in g] for f in g], key=lambda n: half[n])
            smaller = {**half, name: half[name] / 2}
            found = [({**values, name: values[name] + sign * half[name] / 2}, smaller, piece) for sign in (-1, 1)]
        return list(self.add([box for box in found if not self.outside(*box[:2])]))

    def outside(self, values: dict[str, float], half: dict[str, float]) -> bool:
        """Return whether a box lies outside the cone of a ball."""
        for joint in (joint for joint, _ in self.way if joint["cone"] is not None and joint["freedoms"][0]["name"] in half):
            sx, sy = (max(abs(values[f["name"]]) - half[f["name"]], 0.0) for f in joint["freedoms"][:2])
            if math.hypot(sx, sy) > joint["cone"] + ROUNDING:
                return True
        return False

    def refuted(self, number: int) -> str:
        """Return what FCL says of the distance in the middle of a box if it is too small."""
        T, values = self.rows[number][0], self.boxes[number][0]
        if self.models is None:
            self.models = model(self.moved()), model(self.corners_b)
        self.models[1].setTransform(fcl.Transform(T[:3, :3], T[:3, 3]))
        if (distance := fcl.distance(*self.models)) > self.claim["clear_mm"]:
            return ""
        where = ", ".join(f"{name} = {values[name]:.6g}" for name in self.vary)
        return f"at {where} the distance is {distance:.6g} mm, not more than {self.claim['clear_mm']:.6g}"


def model(corners: Any) -> Any:
    """Return triangles `(T, 3, 3)` as an object that FCL can place."""
    bvh = fcl.BVHModel()
    bvh.beginModel(3 * len(corners), len(corners))
    bvh.addSubModel(np.ascontiguousarray(corners.reshape(-1, 3)), np.arange(3 * len(corners)).reshape(-1, 3))
    bvh.endModel()
    return fcl.CollisionObject(bvh)
