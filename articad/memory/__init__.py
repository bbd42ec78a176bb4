"""Experience of earlier runs and the kernels' own documentation: stored, retrieved, returned as text."""
