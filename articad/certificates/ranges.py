"""Ranges over which a certificate is to hold, chosen before anything is proven.

A joint that moves by itself is proven over its limits, and without limits over one turn (`articad.interference.motion.proven_freedoms`).
A driver of a loop or coupling is proven as far as its linkage lets it go, and without limits until all that follows it is back.
"""

from __future__ import annotations

import math

import numpy as np

from articad.certificates.verifier import FLOAT, Checker
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import track_of

MOST_TURNS = 64  # turns of a driver of couplings alone, after which its followers count as never returning


def driven_range(mechanism: Mechanism, checker: Checker, index: int) -> tuple[tuple[float, float], tuple[str, str]]:
    """Return the range over which a driver is to be followed, and what ends it below and above.

    Without limits that is the travel after which all its followers have returned: about rest, or from its only limit.

    Args:
        mechanism: A mechanism with loops or couplings.
        checker: The checker of its certificate.
        index: Index of the driver among the mechanism's.

    Raises:
        ValueError: If its followers do not return.
    """
    driver = mechanism.drivers[index]
    feasible, rest = mechanism.feasible_range(driver.name), float(checker.rest[driver.name])
    reasons = feasible.lower_reason, feasible.upper_reason
    ends, declared = (feasible.lower, feasible.upper), (driver.lower, driver.upper)
    open_ends = [
        math.isinf(limit) and (math.isinf(end) or reason in ("endless", "not followed further"))
        for limit, end, reason in zip(declared, ends, reasons, strict=True)
    ]
    if not any(open_ends):
        return ends, reasons
    length = _period(mechanism, checker, index, 1 if open_ends[1] else -1)
    if all(open_ends):
        return (rest - length / 2, rest + length / 2), reasons
    turns = max(1, math.ceil((ends[1] - rest if open_ends[0] else rest - ends[0]) / length))
    return ((ends[1] - turns * length, ends[1]) if open_ends[0] else (ends[0], ends[0] + turns * length)), reasons


def _period(mechanism: Mechanism, checker: Checker, index: int, sign: int) -> float:
    """Return the travel of a driver after which all its followers have returned up to whole turns [rad]."""
    driver = mechanism.drivers[index]
    names = checker.followers((driver.name,))
    rest = np.array([checker.rest[name] for name in names])
    _, J, share = checker.closure(names, rest, rest)
    turns = np.array([checker.turns[name][2] and not checker.turns[name][3] for name in names])
    if not turns[0]:
        raise ValueError(f"{driver.name} slides without limits")
    if not share.any():  # couplings alone: each follower turns at its own fixed rate
        rates = np.append(1.0, -np.linalg.pinv(J[:, 1:], rcond=1e-7) @ J[:, 0])
        for count in range(1, MOST_TURNS + 1):
            whole = np.where(turns, np.round(count * rates), 0.0)
            if (np.abs(count * rates - whole) <= FLOAT / 2 * np.maximum(1.0, np.abs(whole))).all():
                return 2 * math.pi * count
        raise ValueError(f"the followers of {driver.name} do not return within {MOST_TURNS} of its turns")
    track = track_of(mechanism, index, mechanism.rest)
    period = None if track is None else track.period(sign)
    if period is None:
        raise ValueError(f"the followers of {driver.name} are not known to return after a number of its turns")
    return period.length
