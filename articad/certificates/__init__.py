"""Certificates of motion: what is claimed over whole ranges, how it is proven, and an independent checker."""
