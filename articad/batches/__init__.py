"""Batches: many plans built, checked and exported by a pool of processes or a Dask cluster."""
