"""Realisation: which surfaces of the parts make a joint, and which of its freedoms they remove.

`sides.py` collects the faces of both sides of a joint, `bores.py` finds a pin in its bore, `contacts.py` pairs faces that face each other,
`room.py` computes how far these let the child move, `verdicts.py` judges each joint at rest and at the ends of its range, `meshing.py` whether gears and racks stay in mesh.
"""
