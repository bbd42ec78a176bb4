"""Interference: overlap at one pose, sampled and certified motion, fits, root causes.

`check.py` judges one pose, `sweep.py` samples motion over the ranges of `ranges.py`, `clearance.py` searches for the nearest poses. `overlap.py`
measures one pair, `verdict.py` holds it to what `relations.py` allows. `report.py` is the result, `diagnosis.py` finds causes.
"""
