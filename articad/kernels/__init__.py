"""Build solids from part scripts, in confined processes of their own; B-rep never enters the calling process.

Nothing is imported here: the sandboxed worker is a module of this package and must start fast.
"""
