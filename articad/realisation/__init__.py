"""Realisation: which surfaces of the parts make a joint.

`sides.py` collects the faces of both sides of a joint, `bores.py` finds a pin in its bore and measures their diameters.
"""
