"""Certificates of motion: claims over whole ranges, their proofs, and an independent checker."""
