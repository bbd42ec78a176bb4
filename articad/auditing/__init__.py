"""Audits of files from any source: what is wrong with them, by how much, why, and what to do about it."""
