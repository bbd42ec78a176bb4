"""Where parts are, for the checker of certificates: joints, ways between parts, and what follows a driver of loops.

Written apart from the prover, with NumPy only.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

ROUNDING = 1e-9  # of ranges, distances and angles
REST = 1e-4  # rad or mm: by which what follows may be off at rest


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
        self.rest = {name: f["rest"] for name, f in self.freedoms.items()}
        self.drivers, self.known = certificate["drivers"], dict[Any, list[Any]]()
        self.still = [name for name, joint in self.joints.items() if not joint["freedoms"]]
        self.linked = [f["name"] for name in sorted(certificate["linkage"]) for f in self.joints[name]["freedoms"]]
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
        """Return the loops' and couplings' residuals, their Jacobian, and of each row what is in it, whether it is a length, and its lever."""
        self.turned = 0.0
        r, J, rows = [], [], []
        for way in self.loops:
            T, steps = self.place(way, values, single=True)
            self.turned = max(self.turned, float(np.abs(T[:3, :3] - np.eye(3)).max()))  # half a turn leaves no residual either
            columns = {group[0]["name"]: np.concatenate([v + hat(w) @ T[:3, 3], w]) for group, w, v, _ in steps}
            r += [*T[:3, 3], *((T[[2, 0, 1], [1, 2, 0]] - T[[1, 2, 0], [2, 0, 1]]) / 2)]
            J += np.transpose([columns.get(name, np.zeros(6)) for name in names]).tolist()
            length: Any = sum(np.linalg.norm(np.array(j[key])[:3, 3]) for j, _ in way for key in ("parent_frame", "child_frame"))
            length += sum(math.hypot(*self.freedoms[name]["slide"]) * (1 + abs(values[name])) for name in columns)
            rows += [(set(columns), True, length)] * 3 + [(set(columns), False, length)] * 3
        for c in self.certificate["mechanism"]["couplings"]:
            r.append(values[c["b"]] - c["ratio"] * values[c["a"]] - c["offset"])
            J.append([float(name == c["b"]) - c["ratio"] * (name == c["a"]) for name in names])
            rows.append((set(), False, 1.0))
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

    def followers(self, driver: str) -> list[str]:
        """Return a driver and what follows it: all that is linked, but for other drivers, which stand."""
        return [driver, *(n for n in self.linked if n != driver and n not in self.drivers)]

    def piece(self, driver: str, guess: dict[str, float], middle: float, half: float) -> Any:
        """Return a piece of a driver's range if near its line there is one solution only (Brouwer, Banach), else None.

        It holds the middle, the half length, the values at the middle, and of each coordinate its rate and distance from the line.
        """
        names = self.followers(driver)
        values, r, J, A, rows = self.solve({**guess, driver: middle}, names)
        rate, turns = np.array([1.0, *(-A @ J[:, 0])]), np.array([any(self.freedoms[n]["turn"]) for n in names])
        slide, tube = np.array([math.hypot(*self.freedoms[n]["slide"]) for n in names]), np.zeros(len(names))
        mine, long, arm = np.array([[n in row for n in names] for row, *_ in rows]), *(np.array([row[k] for row in rows]) for k in (1, 2))
        for grow in (2.0, 1.5, 1.2, 1.0):
            lever = arm + mine @ (slide * (np.abs(rate) * half + tube))  # slides lengthen it, and count as turns of far points
            member, curved = mine * np.where(turns, 1.0, 1.0 / np.maximum(lever, 1e-300)[:, None]), np.where(long, lever, 1.0)
            if grow > 1.0:
                residual = np.abs(A @ r) + np.abs(A) @ (curved * (member @ (np.abs(rate) * half + tube)) ** 2) / 2
                tube[1:] = grow * residual + ROUNDING
        reach = member @ (np.abs(rate) * half + tube)
        inside = (self.turned < REST) & (np.abs(A @ r) + np.abs(A) @ (curved * reach**2) / 2 <= tube[1:])
        inside &= (np.abs(A) @ (curved * reach * (member @ tube)) < tube[1:]) & (np.abs(A @ J[:, 1:] - np.eye(len(A))).sum(1) < ROUNDING)
        return (middle, half, values, dict(zip(names, zip(rate, tube, strict=True), strict=True))) if inside.all() else None

    def near(self, piece: Any, values: dict[str, float], driver: str) -> bool:
        """Return whether values are the solution on a piece."""
        middle, _, centre, line = piece
        return all(abs(values[n] - centre[n] - rate * (values[driver] - middle)) <= tube + ROUNDING for n, (rate, tube) in line.items())

    def joined(self, pieces: list[Any]) -> Any:
        """Return pieces in a row as one, which holds them: a line from end to end, as far from it as any of theirs."""
        if len(pieces) == 1:
            return pieces[0]
        ends = sorted(m + sign * h for m, h, *_ in pieces for sign in (-1, 1))
        middle, half = (ends[0] + ends[-1]) / 2, (ends[-1] - ends[0]) / 2
        values, line = dict(pieces[0][2]), dict[str, Any]()
        for name in pieces[0][3]:
            at = np.array(sorted((m + sign * h, v[name] + sign * h * row[name][0]) for m, h, v, row in pieces for sign in (-1, 1)))
            values[name], rate = (at[0, 1] + at[-1, 1]) / 2, (at[-1, 1] - at[0, 1]) / (2 * half)
            aside = np.abs(at[:, 1] - values[name] - rate * (at[:, 0] - middle)).max()
            line[name] = rate, aside + max(row[name][1] for *_, row in pieces)
        return middle, half, values, line, pieces

    def halves(self, driver: str, piece: Any) -> list[Any]:
        """Return a piece in two, each about the solution that the whole one holds; joined ones are parted again."""
        if len(piece) > 4:
            return [self.joined(piece[4][: len(piece[4]) // 2]), self.joined(piece[4][len(piece[4]) // 2 :])]
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
        names, found = self.followers(driver), list[Any]()
        at, step, values = self.rest[driver], (end - self.rest[driver]) / 8, self.solve(self.rest, names)[0]
        if any(abs(values[n] - self.rest[n]) > REST for n in names):
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
