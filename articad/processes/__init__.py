"""Child processes: one launcher with limits, and private temporary folders."""
