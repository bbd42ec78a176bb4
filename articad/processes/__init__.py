"""Child processes: one launcher with limits, and the temporary folders that it leaves to nobody."""
