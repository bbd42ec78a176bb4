"""Trials of files in simulators: whether they load, and what happens when their joints move."""
