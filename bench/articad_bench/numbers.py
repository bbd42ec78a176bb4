"""Numbers of tables: means, medians and shares, each with the ends of its 95 % interval by bootstrap over tasks."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from articad.arrays import FloatArray
from articad_bench.agreement import bootstrap_interval


def mean_of(values: Sequence[float]) -> dict[str, Any]:
    """Return the mean of the values that are there."""
    return _of(values, np.mean)


def median_of(values: Sequence[float]) -> dict[str, Any]:
    """Return the median of the values that are there."""
    return _of(values, np.median)


def share_of(values: Sequence[bool]) -> dict[str, Any]:
    """Return the share of those that hold."""
    return _of([float(value) for value in values], np.mean)


def rounded(value: float) -> float | None:
    """Return a number as the table shows it; None for NaN."""
    return None if math.isnan(value) else round(value, 4)


def _of(values: Sequence[float], statistic: Callable[..., Any]) -> dict[str, Any]:
    sample: FloatArray = np.asarray(values, dtype=float)
    sample = sample[~np.isnan(sample)]
    low, high = bootstrap_interval(sample, statistic)
    name = "median" if statistic is np.median else "mean"
    return {
        name: rounded(float(statistic(sample)) if len(sample) else math.nan),
        "interval": [rounded(low), rounded(high)],
        "n": len(sample),
    }
