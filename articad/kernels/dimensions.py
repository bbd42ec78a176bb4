"""The dimension probe: each dimension is changed, and the script runs again in a process of its own, independent of other runs.

The changed part is measured by one more process, in which no script ran. The probe is bounded by the processor time of these processes, so
that its result does not depend on what else the machine does.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from articad.kernels.results import number, numbers
from articad.kernels.timers import OUT_OF_TIME, WAITING

__all__ = ["failed_attempt", "fingerprint", "is_out_of_time", "probed"]

STEP: Final = 0.02  # the contract's 2 %
ZERO_MM, ZERO_DEG = 0.1, 1.0  # steps for a dimension that is zero
LEAST_SECONDS, PATIENCE = 3.0, 10.0  # a dimension changed by 2 % does not make a script ten times as slow
SAME: Final = 1e-9  # relative change of a number that is rounding
_ORDER: Final = ("changed", "unused", "refused", "broken", "crashed")

Json = dict[str, Any]
Fingerprint = list[float]
Attempt = Callable[[Json, float], tuple[Fingerprint | Json | None, float]]
"""Builds a part with other dimensions within some processor time [s].

Returns its fingerprint, why it fails (an outcome), or None if time ran out; and the processor time that was used [s].
"""


def probed(dimensions: Mapping[str, float], before: Fingerprint, attempt: Attempt, *, seconds: float, own: float) -> Iterator[Json]:
    """Change each dimension by 2 % (a count by 1), upwards and, if that changes nothing or fails, downwards, and build again.

    Outcomes: `changed`; `unused`: both directions give the same part; `refused`: the script itself raised a ValueError or AssertionError
        in both directions; `broken`: it failed otherwise in both directions; `crashed`: the kernel's process died. A dimension without
        time has no outcome.

    Args:
        dimensions: Dimensions of the part.
        before: The fingerprint of the unchanged part.
        attempt: Builds it with other dimensions.
        seconds: Processor time for all dimensions; `WAITING` times as much wall clock ends the probe, too.
        own: Processor time that the part itself took [s].
    """
    until = time.monotonic() + WAITING * seconds
    patience = max(LEAST_SECONDS, PATIENCE * own)
    for name, value in dimensions.items():
        outcomes: list[Json] = []
        for moved in _moves(name, value):
            if seconds <= 0.0 or time.monotonic() > until:
                return
            result, used = attempt({**dimensions, name: moved}, min(seconds, patience))
            seconds -= used
            if result is None:
                outcomes.clear()
                break
            outcomes.append(result if isinstance(result, dict) else {"outcome": "unused" if _is_same(result, before) else "changed"})
            if outcomes[-1]["outcome"] == "changed":
                break
        if outcomes:
            yield {"dimension": name} | min(outcomes, key=lambda outcome: _ORDER.index(outcome["outcome"]))


def fingerprint(shape: Json, connectors: Mapping[str, Json]) -> Fingerprint:
    """Return volume, centre, bounding box, connectors and the squares of the radii of gyration as numbers.

    The last detect motion in a pattern, which changes none of the others.

    Args:
        shape: Properties of a solid, as a process that ran no script reports them.
        connectors: As the script returned them.

    Raises:
        PoisonedError: If something is not a number.
    """
    volume = number(shape.get("volume_mm3"))
    box, inertia = numbers(shape.get("bbox_mm"), 2, 3), numbers(shape.get("inertia_mm5"), 3, 3)
    frames = [
        value
        for name in sorted(connectors)
        for axis in ("o", "z", "x")
        if connectors[name].get(axis) is not None
        for value in numbers(connectors[name][axis], 3)
    ]
    return [
        float(value) for value in (volume, *numbers(shape.get("com_mm"), 3), *box.ravel(), *(inertia / (volume or 1.0)).ravel(), *frames)
    ]


def failed_attempt(said: Json, signal: str, *, late: bool) -> Json | None:
    """Return the outcome of a run that left no part, or None if its time was over.

    Args:
        said: Report of the script's process, if any; untrusted.
        signal: The signal that ended the process, or empty.
        late: Whether it was killed because its time was over.
    """
    if isinstance(said.get("problems"), list):
        return {"outcome": "broken", "error": {"message": "; ".join(map(str, said["problems"][:20]))}}
    if isinstance(error := said.get("error"), dict):
        return {"outcome": "refused" if error.get("refused") is True else "broken", "error": error}
    if is_out_of_time(signal, late=late):
        return None
    return {"outcome": "crashed", "signal": signal} if signal else {"outcome": "broken"}


def is_out_of_time(signal: str, *, late: bool) -> bool:
    """Return whether a process was stopped because its processor time or wall clock was used up.

    Args:
        signal: The signal that ended it, or empty.
        late: Whether it was killed at its deadline.
    """
    return late or signal in (*OUT_OF_TIME, "SIGKILL")


def _moves(name: str, value: float) -> Iterator[float]:
    if name.endswith("_count"):
        yield from (value + 1, value - 1) if value > 1 else (value + 1,)
        return
    step = abs(value) * STEP or (ZERO_DEG if name.endswith("_deg") else ZERO_MM)
    yield from (value + step, value - step)


def _is_same(after: Fingerprint, before: Fingerprint) -> bool:
    scale = max(map(abs, before), default=1.0)
    return len(after) == len(before) and all(
        abs(a - b) <= SAME * max(abs(b), 1e-6 * scale, 1e-3) for a, b in zip(after, before, strict=True)
    )
