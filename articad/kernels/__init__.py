"""Part scripts to solids, in confined processes of their own; B-rep never enters this one.

Nothing is imported here: the sandboxed worker is a module of this package and must start light.
"""
