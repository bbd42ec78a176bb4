"""Exporters: convert an assembly to a bundle of files and a list of losses. Writing to disk comes last."""
