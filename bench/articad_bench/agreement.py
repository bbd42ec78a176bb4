"""How far judges agree, and how sure a mean is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from articad.arrays import FloatArray

Level = Literal["nominal", "ordinal", "interval"]


def krippendorff_alpha(ratings: ArrayLike, level: Level = "ordinal") -> float:
    """Return Krippendorff's α: 1 for judges who agree, 0 for judges who agree no better than chance.

    Args:
        ratings: `(judges, items)`, NaN where a judge gave none.
        level: What differences of ratings mean.

    Returns:
        α = 1 - observed / expected disagreement; NaN where fewer than two ratings can be compared or all are the same value.

    Source:
        K. Krippendorff, Computing Krippendorff's Alpha-Reliability (2011), the canonical form with coincidences.
    """
    table = np.asarray(ratings, dtype=float)
    values = np.unique(table[~np.isnan(table)])
    if not len(values):
        return float("nan")
    counts = np.array([[np.sum(column == value) for value in values] for column in table.T], dtype=float).reshape(-1, len(values))
    given = counts.sum(axis=1)
    counts, given = counts[given > 1], given[given > 1]
    if not len(counts):
        return float("nan")
    pairs = np.einsum("ui,uj->uij", counts, counts) - np.einsum("ui,ij->uij", counts, np.eye(len(values)))
    coincidences = (pairs / (given - 1)[:, None, None]).sum(axis=0)
    totals = coincidences.sum(axis=0)
    distance = _distance(values, totals, level)
    expected = (np.outer(totals, totals) * distance).sum() / (totals.sum() - 1)
    return float(1 - (coincidences * distance).sum() / expected) if expected > 0 else float("nan")


def _distance(values: FloatArray, totals: FloatArray, level: Level) -> FloatArray:
    """Return the squared differences δ² between values, `(v, v)`."""
    if level == "nominal":
        return 1.0 - np.eye(len(values))
    if level == "interval":
        return np.asarray((values[:, None] - values[None, :]) ** 2, dtype=float)
    # Ordinal: as many ranks as there are ratings from one value to the other, each end counted by half.
    ranks = np.cumsum(totals) - totals / 2
    return np.asarray((ranks[:, None] - ranks[None, :]) ** 2, dtype=float)


def icc_2k(ratings: ArrayLike) -> float:
    """Return ICC(2,k): the reliability of the mean of these judges, taken as a sample of all judges.

    Args:
        ratings: `(judges, items)`; items that a judge left out are not counted.

    Returns:
        (MSR - MSE) / (MSR + (MSC - MSE) / n); NaN for fewer than two judges or items.

    Source:
        P. Shrout, J. Fleiss, Intraclass Correlations (1979), case 2, mean of k.
    """
    table = np.asarray(ratings, dtype=float).T
    table = table[~np.isnan(table).any(axis=1)]
    n, k = table.shape if table.ndim == 2 else (0, 0)
    if min(n, k) < 2:
        return float("nan")
    mean = table.mean()
    between = k * ((table.mean(axis=1) - mean) ** 2).sum() / (n - 1)
    judges = n * ((table.mean(axis=0) - mean) ** 2).sum() / (k - 1)
    rest = ((table - table.mean(axis=1, keepdims=True) - table.mean(axis=0) + mean) ** 2).sum() / ((n - 1) * (k - 1))
    below = between + (judges - rest) / n
    return float((between - rest) / below) if below > 0 else float("nan")


def bootstrap_interval(
    values: ArrayLike, statistic: Callable[..., Any] = np.mean, *, confidence: float = 0.95, resamples: int = 10_000, seed: int = 0
) -> tuple[float, float]:
    """Return the percentile interval of a mean or median; both ends NaN without values, both the value with one."""
    sample = np.asarray(values, dtype=float)
    sample = sample[~np.isnan(sample)]
    if len(sample) < 2:
        only = float(sample[0]) if len(sample) else float("nan")
        return only, only
    found = stats.bootstrap(
        (sample,), statistic, confidence_level=confidence, n_resamples=resamples, method="percentile", rng=np.random.default_rng(seed)
    )
    return float(found.confidence_interval.low), float(found.confidence_interval.high)


def bootstrap_items(
    ratings: FloatArray, measure: Callable[[FloatArray], float], *, confidence: float = 0.95, resamples: int = 1000, seed: int = 0
) -> tuple[float, float]:
    """Return the percentile interval of a measure of agreement, items drawn with replacement; draws that have no value are left out."""
    rng, items = np.random.default_rng(seed), ratings.shape[1]
    draws = [measure(ratings[:, rng.integers(items, size=items)]) for _ in range(resamples)] if items > 1 else []
    told = np.array([draw for draw in draws if not np.isnan(draw)])
    if not len(told):
        return float("nan"), float("nan")
    low, high = np.quantile(told, [(1 - confidence) / 2, (1 + confidence) / 2])
    return float(low), float(high)
