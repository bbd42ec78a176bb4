"""What a certificate that is marked ok covers, in a sentence: what moves together, and what holds within tolerance."""

from __future__ import annotations

import math
from typing import Any

from articad.certificates.verifier import PROOF, Checker

__all__ = ["covered"]


def covered(certificate: dict[str, Any]) -> str:
    """Return a sentence on what moves together in the claims of a certificate that is marked ok, and what does not."""
    asked = ", ".join(certificate["asked"]) or "none"
    free = [joint["name"] for joint in certificate["mechanism"]["joints"] if joint["type"] == "free"]
    still = f" Not covered: free joints stay at rest throughout ({', '.join(free)})." if free else ""
    checker = Checker(certificate, {PROOF: {}})
    still += _within(checker)
    left = [f"{a}/{b}" for a, b, _ in checker.missing()]
    some = f"{', '.join(left[:4])}{f' and {len(left) - 4} more' if len(left) > 4 else ''}"
    if not left:
        return f"proven while all of these joints move at once, each over its whole range: {asked}.{still}"
    if not certificate["together"]:
        return f"proven for every joint alone, the others at rest: {asked}; two or more at once: not covered for {some}.{still}"
    return f"proven for every joint alone and every two together: {asked}; three or more at once: not covered for {some}.{still}"


def _within(checker: Checker) -> str:
    """Return a sentence on what a certificate that is marked ok claims within tolerance; nothing if it claims nothing so."""
    certificate, stated = checker.certificate, checker.certificate.get("tolerance")
    if stated is None:
        return ""
    ruled = {frozenset(row["parts"]) for row in stated["rows"]}
    clear = len({frozenset(claim["parts"]) for claim in certificate["claims"] if checker.tolerance.counts(claim)} - ruled)
    pairs = math.comb(len(certificate["meshes"]), 2)
    by = {kind: [row for row in stated["rows"] if row["by"] == kind] for kind in ("fit", "contact", "waiver")}
    shares, said = stated["shares_mm"].values(), [f"{clear} of {pairs} pairs of parts stay clear"]
    if by["fit"]:
        plays = [row["least_mm"] for row in by["fit"]]
        said.append(f"{len(plays)} ruled by their declared fits (least play {min(plays):.4g} mm), of which nothing else is claimed")
    deep = [row["depth_mm"] for row in by["contact"] if "depth_mm" in row]
    if deep:
        said.append(f"{len(deep)} touch by design, proven only no deeper than {max(deep):.4g} mm")
    if len(by["contact"]) > len(deep):
        said.append(f"{len(by['contact']) - len(deep)} fixed to each other and said to touch, of which nothing is claimed")
    if by["waiver"]:
        said.append(f"{len(by['waiver'])} waived")
    if pairs > clear + len(ruled):
        said.append(f"{pairs - clear - len(ruled)} not claimed, as no requested joint moves them")
    span = f"{min(shares, default=0):g} to {max(shares, default=0):g} mm, by its part's largest extent"
    return (
        f" Within ISO 2768-{stated['class']}, each point of a surface up to its tolerance ({span}) from its nominal place, frames of joints "
        f"exact: {'; '.join(said)}."
    )
