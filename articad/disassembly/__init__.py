"""Disassembly: which ways parts have out of an assembly, and the order of assembly that this gives backwards.

`contacts.py` computes how far a surface moves in a straight line before it meets another, `ways.py` does so for parts, `order.py` takes an
assembly apart, `poses.py` finds further configurations in which
parts may be put in place, `steps.py` is the form of the result.
"""
