"""Audits of files that anyone made: what is wrong with them, by how much, why, and what to do about it."""
