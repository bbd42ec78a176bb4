"""Importers: convert files to assemblies; articad's own files come back exactly as they were."""
