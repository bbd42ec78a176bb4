"""Support: what carries each part against its weight, whether the product stands, and what falls out of it.

`stance.py` compares the centre of mass with the polygon on which the product stands, `carried.py` finds what carries each body,
`check.py` does both at rest and at the ends of the drivers' ranges.
"""
