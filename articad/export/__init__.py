"""Exporters: convert an assembly to a bundle of files and a list of losses. Writing to disk comes last.

One module for each format: `urdf.py`, `mjcf.py`, `sdf.py`, `usd.py`, `step.py`, `gltf.py`, `threemf.py`, `freecad.py`, `plan.py`. `lowering.py` turns an
assembly into links and one-freedom joints for the first three; `losses.py` is the table of what each format cannot say; `mimic.py` and
`follow.py` write couplings and loops.
"""
