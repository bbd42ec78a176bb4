"""Exporters: an assembly in, a bundle of files and a list of losses out. Writing to disk comes last."""
