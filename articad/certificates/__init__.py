"""Certificates of motion: claims over whole ranges, their proofs, and an independent checker.

`certificate.py` builds a certificate and lists what it covers; `ranges.py` chooses the range of each joint and driver.
`proof.py` proves pairs whose joints move by themselves, `linkage.py` those along drivers of loops and couplings; both search by
branch and bound (`clearing.py`), with bounds from `spread.py` and `profile.py`. `claims.py` and `trail.py` are what is written down.
`fits.py` proves declared fits, `tolerance.py` claims within tolerance; `covers.py` says what is covered. `verifier.py` checks a written
certificate, with `verifier_files.py` and `verifier_tolerance.py`; the three import none of the others.
"""
