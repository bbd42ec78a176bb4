"""Importers: convert files to assemblies; articad's own files come back exactly as they were.

One module for each format: `urdf.py` (joints, limits, mimic), `xacro.py`, `sdf.py`, `srdf.py`, `mjcf.py`, `freecad.py`, `step.py`; `*_kept.py` and
`mjcf_carried.py` collect what an assembly has no field for. URDF and MJCF fill the lists of `raw.py`, which makes the assembly of them; `records.py`
restores articad's own. `fusing.py` joins chains of joints into one, `fused_loops.py` constraints that close a loop. `referenced_files.py` bounds which files a file may make an engine open.
"""
