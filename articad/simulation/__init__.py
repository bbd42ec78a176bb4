"""What simulators make of a file: whether they load it, and what happens when its joints move."""
