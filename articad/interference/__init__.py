"""Interference: overlap at one pose, sampled and certified motion, fits, root causes."""
