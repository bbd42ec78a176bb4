"""Check a motion certificate without trusting it: what `articad verify-certificate` asks.

Written apart from the prover, with NumPy and python-fcl only. A certificate holds statements: these parts keep apart while these
joints move within these ranges. Each is proven here anew from the meshes and the joints, and none may be missing. Where parts are
is in `verify_motion`, whether surfaces keep apart in `verify_apart`; that is all a reader has to trust.
"""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from articad.verify_apart import Search, Tree, normal
from articad.verify_motion import ROUNDING, Mechanism


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return why a certificate file is refuted, nothing if it is accepted; `folder` holds `<part>.npz` of every part."""
    content = file.read_bytes()
    try:
        certificate = json.loads(content)
        names = list(certificate["meshes"])
        if outside := [name for name in names if Path(name).name != name]:
            return [f"{outside[0]!r} is no name of a mesh"]
        if left := sorted({file.stem for file in folder.glob("*.npz")} - set(names)):
            return [f"it says nothing of {', '.join(left)}"]
        found = {name: _mesh(folder / f"{name}.npz") for name in names}
    except Exception as error:  # noqa: BLE001 - zipfile and NumPy raise whatever they stumble over, and each refutes
        return [f"it cannot be read: {error!r}"[:500]]
    return verify(certificate, found)


def _mesh(file: Path) -> tuple[Any, Any]:
    with file.open("rb") as stream, np.load(stream, allow_pickle=False) as arrays:
        return arrays["vertices"], arrays["triangles"]


def verify(certificate: dict[str, Any], meshes: dict[str, tuple[Any, Any]]) -> list[str]:
    """Return why the certificate is refuted, nothing if it is accepted; `meshes`: vertices (V, 3), triangles (T, 3) by part."""
    try:
        return _faults(certificate, meshes)
    except Exception as error:  # noqa: BLE001 - a certificate that breaks its checker, in whatever way, proves nothing
        return [f"it does not hold together: {error!r}"[:500]]


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
        missing = (
            [] if {a, b} in waived else [names for names in sets(mechanism, a, b) if not any(covers(mechanism, c, names) for c in mine)]
        )
        found += [f"{a}/{b} over {', '.join(sorted(names))}: no claim, yet the certificate calls itself ok" for names in missing]
    if certificate["ok"] and mechanism.linked and set(certificate["linkage"]) <= {*certificate["asked"], *mechanism.still}:
        J = mechanism.closure(mechanism.rest, mechanism.followers(""))[1][:, 1:]
        if J.shape[1] > np.linalg.matrix_rank(J, tol=1e-7 * max(np.abs(J).max(initial=0.0), 1.0)):
            found.append("more moves in the loops than their drivers")
    return found


def sets(mechanism: Mechanism, a: str, b: str) -> list[set[str]]:
    """Return the sets of coordinates over which two parts are to be proven apart."""
    names, certificate = [joint["name"] for joint, _ in mechanism.way(a, b)], mechanism.certificate
    free = [n for n in names if n in certificate["asked"] and n not in certificate["linkage"]]
    moving = [{f["name"] for f in mechanism.joints[n]["freedoms"]} for n in free]
    tied = any(f["joint"] in names for f in map(mechanism.freedoms.get, mechanism.linked) if f)
    drivers = [{name} for name in certificate["drivers"]] if tied else []
    both = [x | y for x, y in (*itertools.combinations(moving, 2), *itertools.product(drivers, moving)) if certificate["together"]]
    return [wanted for wanted in [*moving, *drivers, *both] if wanted]


def covers(mechanism: Mechanism, claim: dict[str, Any], names: set[str]) -> bool:
    """Return whether a claim varies these coordinates; one on whatever a linkage does covers all its drivers."""
    tied = {name for name in mechanism.linked if mechanism.freedoms[name]["joint"] in claim["via"]}
    return names - (set(mechanism.drivers) if tied <= set(claim["vary"]) else set()) <= set(claim["vary"])


def digest(mesh: tuple[Any, Any] | None) -> str:
    """Return the hash of a mesh as it stands in a certificate."""
    v, f = (np.ascontiguousarray(array, dtype) for array, dtype in zip(mesh or ([], []), ("<f8", "<i4"), strict=True))
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


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
        self.way = mechanism.way(claim["parts"][0], claim["parts"][1], claim["via"])
        self.freedoms = [f for joint, _ in self.way for f in joint["freedoms"]]
        self.tied = {f["name"] for f in self.freedoms} - {*self.vary, *claim["hold"]}
        (self.V, self.F), (V, F) = (meshes[name] for name in claim["parts"])
        self.corners_b = V[F]

    def fault(self) -> str:
        """Return why the claim is refused, or nothing."""
        reason, at_rest = next(self.misstated(), ""), self.mechanism.place(self.way, self.mechanism.rest, single=False)
        if reason:
            return reason
        driver = next((n for n in self.vary if n in self.mechanism.drivers), None) if self.tied else None
        T, corners = at_rest[0], self.moved(at_rest[1])
        both = corners, self.corners_b @ T[:3, :3].T + T[:3, 3]
        if any(winding(point, other) > 0.5 for one, other in (both, both[::-1]) for point in shells(one)):
            return "one part is inside the other at the start"  # if not, surfaces that never meet keep it so
        search = Search(self.mechanism, self.way, self.claim, driver, (corners, self.corners_b))
        return search.apart(*self.facing(corners))

    def misstated(self) -> Iterator[str]:
        """Yield what is wrong with the statement before anything is proven."""
        claim, vary, linked = self.claim, self.vary, set(self.mechanism.linked)
        if self.tied - linked or (self.tied and not set(vary) & set(self.mechanism.drivers)):
            yield "not all that moves between the two is named"
        if self.tied and len(set(vary) & set(self.mechanism.drivers)) > 1:
            yield "two drivers move at once"  # what follows was followed along one
        if any(not low - ROUNDING <= self.mechanism.rest[name] <= high + ROUNDING for name, (low, high) in vary.items()):
            yield "it does not begin at rest"
        if linked & set(vary) and linked & set(claim["hold"]):
            yield "what follows a driver is said to stand"
        if any(abs(value - self.mechanism.rest[name]) > ROUNDING for name, value in claim["hold"].items()):
            yield "what is held does not stand at rest"
        for name, (low, high) in vary.items() if self.certificate["ok"] else ():
            least, most = self.mechanism.freedoms[name]["range"]
            if low > least + 1e-6 or high < most - 1e-6:
                yield f"{name} is varied over [{low:.6g}, {high:.6g}] only"
        entries = [pair["strength"] for pair in self.certificate["pairs"] if set(pair["parts"]) == set(claim["parts"])]
        if self.certificate["ok"] and claim["shrink_mm"] > max([e.get("epsilon_mm", 0.0) for e in entries], default=0.0) + ROUNDING:
            yield f"it allows an overlap of {claim['shrink_mm']:.6g} mm, more than it says"
        if claim["clear_mm"] < sum(self.certificate["meshes"][name]["deflection_mm"] for name in claim["parts"]) - ROUNDING:
            yield f"a distance of {claim['clear_mm']:.6g} mm is less than the deflection of the meshes"

    def moved(self, steps: list[Any]) -> Any:
        """Return the first part's triangles, their vertices moved inwards: all of them, or those near the axis of the joint."""
        V, within = inwards(self.V, self.F, self.claim["shrink_mm"]), self.claim["within_mm"]
        if within is not None:
            frame, ball = next(((T, len(group) > 1) for group, _, _, T in steps if group[0]["name"] in self.vary), (np.eye(4), True))
            local = (self.V - frame[:3, 3]) @ frame[:3, : 3 if ball else 2]
            V = np.where(np.linalg.norm(local, axis=1, keepdims=True) <= within, V, self.V)
        return V[self.F]

    def facing(self, a: Any) -> tuple[Any, Any]:
        """Return the triangles of both parts that a joint about one axis or point could bring together, if it is the only one."""
        rest, b = self.mechanism.rest, self.corners_b
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
