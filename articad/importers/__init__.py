"""Importers: somebody's file in, an assembly out; articad's own files come back as they were."""
