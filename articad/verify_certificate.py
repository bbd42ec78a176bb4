"""Check a motion certificate without trusting it: what `articad verify-certificate` asks.

Written apart from the prover, with NumPy and python-fcl only. Everything that a claim rests on is computed anew: mesh hashes,
poses, distances, speeds, that boxes cover the ranges, that pieces make up the surface, that no pair or range is missing.
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

TOLERANCE_MM = 1e-6  # between a number that is claimed and the same one computed here
ROUNDING = 1e-9  # of ranges and, relatively, of speeds


def verify_file(file: Path, folder: Path) -> list[str]:
    """Return why a certificate file is refuted, nothing if it is accepted; `folder` holds `<part>.npz` of every part."""
    certificate = json.loads(file.read_text())
    found = {name: np.load(folder / f"{name}.npz", allow_pickle=False) for name in certificate["meshes"]}
    return verify(certificate, {name: (arrays["vertices"], arrays["triangles"]) for name, arrays in found.items()})


def verify(certificate: dict[str, Any], meshes: dict[str, tuple[Any, Any]]) -> list[str]:
    """Return why the certificate is refuted, nothing if it is accepted; `meshes`: vertices (V, 3), triangles (T, 3) by part."""
    entries = certificate["meshes"]
    found = [f"mesh of {name} is missing or another" for name in entries if digest(meshes.get(name)) != entries[name]["sha256"]]
    groups: dict[Any, list[dict[str, Any]]] = {}
    for claim in certificate["claims"]:
        groups.setdefault((tuple(claim["parts"]), tuple(sorted(claim["vary"]))), []).append(claim)
    for (parts, names), claims in [] if found else groups.items():
        found += [f"{parts[0]}/{parts[1]} over {', '.join(names)}: {fault}" for fault in Pair(certificate, meshes, claims).faults()]
    proven = [(set(parts), set(names)) for parts, names in groups]
    waived = [set(pair["parts"]) for pair in certificate["pairs"] if pair["strength"]["kind"] == "waived"]
    for a, b in itertools.combinations(entries if certificate["ok"] else (), 2):
        moving = [joint["freedoms"] for joint, _ in path(certificate, a, b) if joint["name"] in certificate["asked"]]
        for several in [*((f,) for f in moving), *(itertools.combinations(moving, 2) if certificate["together"] else ())]:
            names = {freedom["name"] for freedoms in several for freedom in freedoms}
            if {a, b} not in waived and not any(pair == {a, b} and names <= varied for pair, varied in proven):
                found.append(f"{a}/{b} over {', '.join(sorted(names))}: no claim, yet the certificate calls itself ok")
    return found


def digest(mesh: tuple[Any, Any] | None) -> str:
    """Return the hash of a mesh as it stands in a certificate."""
    v, f = (np.ascontiguousarray(array, dtype) for array, dtype in zip(mesh or ([], []), ("<f8", "<i4"), strict=True))
    return hashlib.sha256(b"articad.mesh/1" + np.array([len(v), len(f)], "<i8").tobytes() + v.tobytes() + f.tobytes()).hexdigest()


def path(certificate: dict[str, Any], a: str, b: str) -> list[tuple[dict[str, Any], bool]]:
    """Return the joints from a to b, each with whether it is crossed from parent to child."""
    ways: dict[str, list[Any]] = {a: []}
    todo = [a]
    for part in todo:
        for joint in certificate["mechanism"]["joints"]:
            for near, far, forward in ((joint["parent"], joint["child"], True), (joint["child"], joint["parent"], False)):
                if near == part and far not in ways and not joint["loop"]:
                    ways[far] = [*ways[part], (joint, forward)]
                    todo.append(far)
    return ways[b]


def motion(freedoms: list[dict[str, Any]], values: dict[str, float]) -> Any:
    """Return the turn about Σ turn·q by its length and the slide by Σ slide·q, `(4, 4)` (Rodrigues)."""
    w, t = (np.sum([np.array(f[key]) * values[f["name"]] for f in freedoms], axis=0) for key in ("turn", "slide"))
    T, angle = np.eye(4), math.hypot(*w)
    K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]) / (angle or 1.0)
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    T[:3, 3] = t
    return T


def model(corners: Any) -> Any:
    """Return triangles `(T, 3, 3)` as an object that FCL can place."""
    bvh = fcl.BVHModel()
    bvh.beginModel(3 * len(corners), len(corners))
    bvh.addSubModel(np.ascontiguousarray(corners.reshape(-1, 3)), np.arange(3 * len(corners)).reshape(-1, 3))
    bvh.endModel()
    return fcl.CollisionObject(bvh)


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
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    for k in range(3):
        u, v = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))
        np.add.at(total, F[:, k], normal / np.where(size > 0, size, 1) * angle[:, None])
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return V - depth * total / np.where(size > 0, size, 1)


class Pair:
    """All claims on two parts over the same coordinates."""

    def __init__(self, certificate: dict[str, Any], meshes: dict[str, Any], claims: list[dict[str, Any]]) -> None:
        parts = claims[0]["parts"]
        self.claims, self.full, self.path = claims, certificate["ok"], path(certificate, *parts)
        (self.V, self.F), (V, F) = (meshes[name] for name in parts)
        self.moving = [f for joint, _ in self.path for f in joint["freedoms"] if f["name"] in claims[0]["vary"]]
        self.names = [f["name"] for f in self.moving]
        self.delta = sum(certificate["meshes"][name]["deflection_mm"] for name in parts)
        strengths = [pair["strength"] for pair in certificate["pairs"] if set(pair["parts"]) == set(parts)]
        self.allowed = max([strength.get("epsilon_mm", 0.0) for strength in strengths], default=0.0) if self.full else math.inf
        self.T_start, self.way = self.pose({**claims[0]["hold"], **claims[0]["start"]})
        self.axis = next(T for step, T, _, _ in self.way if step[0]["name"] in self.names)
        self.dims = 3 if any(f["turn"][0] or f["turn"][1] for f in self.moving) else 2  # radii from the centre, or from the axis
        self.corners_b, self.corners_b_start = V[F], V[F] @ self.T_start[:3, :3].T + self.T_start[:3, 3]

    def pose(self, values: dict[str, float]) -> tuple[Any, list[Any]]:
        """Return T_a_b and every step of the way: its freedoms, the frames in front of and behind it, its direction."""
        T, way = np.eye(4), []
        for joint, forward in self.path:
            L, R = np.array(joint["parent_frame"]), np.linalg.inv(joint["child_frame"])
            T = T @ (L if forward else np.linalg.inv(R))
            steps = [list(step) for _, step in itertools.groupby(joint["freedoms"], lambda f: f["step"])]
            for step in steps if forward else steps[::-1]:
                before, J = T, motion(step, values)
                T = T @ (J if forward else np.linalg.inv(J))
                way.append((step, before, T, 1 if forward else -1))
            T = T @ (R if forward else np.linalg.inv(L))
        return T, way

    def faults(self) -> list[str]:
        """Return what is wrong with the claims, together and one by one."""
        first, by = self.claims[0], {claim["piece"]: claim for claim in self.claims}
        for f in [f for joint, _ in self.path for f in joint["freedoms"]]:
            low, high = first["vary"].get(f["name"], f["range"])
            if self.full and (low > f["range"][0] + ROUNDING or high < f["range"][1] - ROUNDING):
                return [f"{f['name']} is varied over [{low:.6g}, {high:.6g}] only"]
        same = all(claim[key] == first[key] for claim in self.claims for key in ("hold", "start", "radius_mm", "edge_mm"))
        depth = {piece: claim["shrink_mm"] for piece, claim in by.items()}
        cut = set(by) in ({"in", "out"}, {"in", "seam", "out"}) and depth["out"] == depth.get("seam", 0.0) == 0.0
        cut = cut and depth["in"] <= (by["seam"]["clear_mm"] if "seam" in by else 0.0)
        if not (same and len(by) == len(self.claims) and (cut or set(by) == {"whole"})):
            return ["the pieces do not make up the surface"]
        if max(depth.values()) > self.allowed + TOLERANCE_MM:
            return [f"it allows an overlap of {max(depth.values()):.6g} mm, more than it says"]
        both = (inwards(self.V, self.F, max(depth.values()))[self.F], self.corners_b_start)
        if any(winding(point, other) > 0.5 for one, other in (both, both[::-1]) for point in shells(one)):
            return ["one part is inside the other at the start"]  # if not, surfaces that never meet keep it so
        return [fault for claim in self.claims if len(piece := self.surface(claim)) for fault in self.faults_of(claim, piece)]

    def surface(self, claim: dict[str, Any]) -> Any:
        """Return the triangles of the claim's piece, `(T, 3, 3)`."""
        todo = np.concatenate([self.V, inwards(self.V, self.F, claim["shrink_mm"])], 1)[self.F]
        pieces = {"whole": [todo], "in": [], "seam": [], "out": []}
        while len(todo) and claim["piece"] != "whole":
            local = (todo[..., :3] - self.axis[:3, 3]) @ self.axis[:3, : self.dims]
            middle = local.mean(1)
            sure = np.linalg.norm(middle, axis=1) - np.linalg.norm(local - middle[:, None], axis=2).max(1) > claim["radius_mm"]
            within = (np.linalg.norm(local, axis=2) <= claim["radius_mm"]).all(1)
            short = np.linalg.norm(todo[..., :3] - todo[:, [1, 2, 0], :3], axis=2).max(1) <= claim["edge_mm"]
            for name, chosen in (("in", within), ("seam", ~within & ~sure & short), ("out", ~within & (sure | short))):
                pieces[name].append(todo[chosen])
            a, b, c = np.moveaxis(todo[~within & ~sure & ~short], 1, 0)
            ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
            todo = np.concatenate([np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        return np.concatenate(pieces[claim["piece"]])[..., 3:]  # outside the inner piece nothing is shrunk

    def faults_of(self, claim: dict[str, Any], surface: Any) -> list[str]:
        """Check a claim's invariant separation; or its speeds, its boxes and the distance in each."""
        needed, n = self.delta + claim["tube_mm"] + claim["clear_mm"], len(self.names)
        if claim["separation"] is not None:
            gap = self.gap_along(surface) if claim["separation"] == "along" else self.gap_of_radii(surface)
            return [] if gap > max(needed, claim["gap_mm"] - TOLERANCE_MM) else [f"the invariant gap is {gap:.6g} mm"]
        reach = np.array([claim["reach"][name] for name in self.names])
        found = ["a point is faster than claimed"] if (reach < self.reach(surface.reshape(-1, 3)) * (1 - ROUNDING)).any() else []
        here, there, boxes = model(surface), model(self.corners_b), np.array(claim["boxes"]).reshape(-1, 2 * n + 1)
        for row in boxes:
            T, _ = self.pose({**claim["hold"], **dict(zip(self.names, row[:n].tolist(), strict=True))})
            there.setTransform(fcl.Transform(T[:3, :3], T[:3, 3]))
            distance = fcl.distance(here, there)
            if row[-1] > distance + TOLERANCE_MM or not distance > reach @ row[n:-1] + needed:
                found.append(f"{claim['piece']}: at {row[:n].tolist()} the distance is {distance:.6g} mm, not as claimed or too little")
        low, high = np.array([claim["vary"][name] for name in self.names], dtype=float).T
        complete = self.covered(low, high, boxes[:, :n] - boxes[:, n:-1], boxes[:, :n] + boxes[:, n:-1])
        return found + [f"{claim['piece']}: the boxes leave a gap"] * (not complete)

    def covered(self, low: Any, high: Any, bottom: Any, top: Any) -> bool:
        """Return whether boxes cover a range, cut where one of them ends; what lies outside a ball's cone needs no cover."""
        for joint in [joint for joint, _ in self.path if joint["cone"] is not None and joint["freedoms"][0]["name"] in self.names]:
            at = self.names.index(joint["freedoms"][0]["name"])
            if np.hypot(*np.maximum(np.maximum(low, -high), 0)[at : at + 2]) > joint["cone"] + ROUNDING:
                return True
        whole = bool(((bottom <= low + ROUNDING) & (top >= high - ROUNDING)).all(1).any())
        ends = [(e, k) for rows in (bottom, top) for row in rows for k, e in enumerate(row) if low[k] + ROUNDING < e < high[k] - ROUNDING]
        if whole or not ends:
            return whole
        cut, axis = sorted(ends)[len(ends) // 2]
        here = np.arange(len(low)) == axis
        halves = [(low, np.where(here, cut, high)), (np.where(here, cut, low), high)]
        near = [((bottom < hi - ROUNDING) & (top > lo + ROUNDING)).all(1) for lo, hi in halves]
        return all(self.covered(lo, hi, bottom[rows], top[rows]) for (lo, hi), rows in zip(halves, near, strict=True))

    def reach(self, points: Any) -> Any:
        """Bound the speed of b as seen from a per unit of each coordinate, by the radii of a or of b, whichever are smaller."""
        bounds = []
        for side in (1, -1):  # a cloud of points, each with a radius of doubt, goes from its own part to the other
            cloud, doubt, speed = points if side == 1 else self.corners_b_start.reshape(-1, 3), 0.0, {}
            for step, before, behind, sign in self.way[::side]:
                frame, moving = before if side == 1 else behind, [f for f in step if f["name"] in self.names]
                local = (cloud - frame[:3, 3]) @ frame[:3, :3]
                for f in moving:  # about one axis the distance from it counts, about several that from the centre
                    radius = np.linalg.norm(np.cross(local, f["turn"]) if len(step) == 1 else local, axis=1).max() + doubt
                    speed[f["name"]] = math.hypot(*f["slide"]) + any(f["turn"]) * radius
                if any(any(f["turn"]) for f in moving):
                    cloud, doubt = frame[None, :3, 3], np.linalg.norm(local, axis=1).max() + doubt
                for f in moving:  # slides reach furthest at their ends
                    way = -side * sign * frame[:3, :3] @ f["slide"]
                    cloud = np.concatenate([cloud + (end - self.claims[0]["start"][f["name"]]) * way for end in f["range"]])
            bounds.append([speed[name] for name in self.names])
        return np.min(bounds, axis=0)

    def gap_along(self, surface: Any) -> float:
        """Return the gap of the extents along a direction that all joints keep; negative if there is none."""
        u, slack = self.axis[:3, 2], np.zeros(2)
        for f, T, sign in [(f, T, sign) for step, T, _, sign in self.way for f in step if f["name"] in self.names]:
            if np.linalg.norm(np.cross(T[:3, :3] @ f["turn"], u)) > ROUNDING:
                return -math.inf
            slack += np.sort(sign * (T[:3, :3] @ f["slide"] @ u) * (np.array(f["range"]) - self.claims[0]["start"][f["name"]]))
        mine, theirs = surface.reshape(-1, 3) @ u, self.corners_b_start.reshape(-1, 3) @ u
        return float(max(theirs.min() + slack[0] - mine.max(), mine.min() - theirs.max() - slack[1]))

    def gap_of_radii(self, surface: Any) -> float:
        """Return by how much one part keeps within a radius about the one joint that the other keeps out of."""
        flat = [(corners - self.axis[:3, 3]) @ (self.axis[:3, :3] * [1, 1, self.dims - 2]) for corners in (surface, self.corners_b_start)]
        most = [np.linalg.norm(corners, axis=2).max() for corners in flat]
        least = [fcl.distance(model(corners), model(np.zeros((1, 3, 3)))) for corners in flat]
        steady = len({f["joint"] for f in self.moving}) == 1 and not any(any(f["slide"][: self.dims]) for f in self.moving)
        return float(max(least[1] - most[0], least[0] - most[1])) if steady else -math.inf
