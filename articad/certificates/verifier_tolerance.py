"""Check claims within tolerance without trusting them: a part of the checker in `verifier.py`, which shares nothing with the prover.

Each point of a part's surface may lie up to its share from its nominal place. So two parts stay clear if their meshes keep the deflections
plus both shares: an ordinary claim, which the checker proves. What is checked here is that the shares are those of the standard, that every
claim that counts keeps them, and that pairs without such a claim are ruled by something that the certificate states.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

ROUNDING = 1e-9  # mm, of distances
SIZES = (3, 6, 30, 120, 400, 1000, 2000, 4000)  # mm: upper ends of the steps of ISO 2768-1, table 1
GENERAL = {  # its permissible deviations by class [mm]; an infinite one is not in the standard
    "f": (0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, math.inf),
    "m": (0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0),
    "c": (0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0),
    "v": (math.inf, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0),
}


class Tolerance:
    """What a certificate states about tolerances; nothing if it does not."""

    def __init__(self, certificate: dict[str, Any]) -> None:
        self.certificate, self.stated = certificate, certificate.get("tolerance")
        self.rows = [] if self.stated is None else [(row, {*row["parts"]}) for row in self.stated["rows"]]

    def counts(self, claim: dict[str, Any]) -> bool:
        """Return whether a claim is enough for its pair: within tolerance it keeps the shares of both parts, unless something else rules."""
        row = next((row for row, pair in self.rows if pair == {*claim["parts"]}), None)
        if self.stated is None or (row is not None and row["by"] != "contact"):
            return True
        shares = sum(self.stated["shares_mm"].get(name, math.inf) for name in claim["parts"])
        if row is not None and claim["shrink_mm"] > 0:
            return bool(row.get("depth_mm", 0.0) >= claim["shrink_mm"] + shares - ROUNDING)
        deflections = sum(self.certificate["meshes"][name]["deflection_mm"] for name in claim["parts"])
        return bool(claim["shrink_mm"] == 0 and claim["clear_mm"] >= deflections + shares - ROUNDING)

    def faults(self, meshes: dict[str, Any], together: Callable[[str, str], bool]) -> Iterator[str]:
        """Yield what is wrong: a share, a pair that is excused without a reason, parts that stand too close to each other.

        Args:
            meshes: By part, with `vertices` [mm].
            together: Whether no joint moves two parts against each other.
        """
        if self.stated is None:
            return
        permitted = GENERAL.get(self.stated["class"], (math.inf,) * len(SIZES))
        for name in self.certificate["meshes"]:
            size = round(float(np.ptp(meshes[name]["vertices"], axis=0).max()), 6)
            share = next((share for end, share in zip(SIZES, permitted, strict=True) if size <= end), math.inf)
            if not share < math.inf or self.stated["shares_mm"].get(name) != share:
                yield f"the tolerance of {name} is not that of ISO 2768-1 for its {size:.6g} mm"
        pairs = [pair for _, pair in self.rows]
        for row, pair in self.rows:
            if pairs.count(pair) > 1 or not self.rules(row, together):
                yield f"nothing rules {'/'.join(row['parts'])}, or it is said twice"
        known = pairs + [{*claim["parts"]} for claim in self.certificate["claims"] if self.counts(claim)]
        for a, b in itertools.combinations(self.certificate["meshes"], 2):
            if together(a, b) and {a, b} not in known:
                yield f"{a}/{b} do not move against each other, and are not proven clear within tolerance"

    def rules(self, row: dict[str, Any], together: Callable[[str, str], bool]) -> bool:
        """Return whether something rules the pair of a row: a contact, a waiver of the plan, or fits of joints that connect the two.

        All joints between the two must have a fit, and none that moves one that may lock it.
        """
        pair, joints = {*row["parts"]}, self.certificate["mechanism"]["joints"]
        if row["by"] != "fit":
            waived = [{*pair["parts"]} for pair in self.certificate["pairs"] if pair["strength"]["kind"] == "waived"]
            return row["by"] == "contact" or (row["by"] == "waiver" and pair in waived)
        named = [joint for joint in joints if joint["name"] in row["joints"]]
        between = {joint["name"] for joint in joints if {joint["parent"], joint["child"]} == pair}
        connect = [
            any(together(a, joint["parent"]) and together(b, joint["child"]) for a, b in itertools.permutations(row["parts"]))
            for joint in named
        ]
        holds = row["least_mm"] >= 0 or not any(joint["freedoms"] for joint in named)
        return bool(named and all(connect) and between <= {*row["joints"]} and holds)
