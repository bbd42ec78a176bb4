"""What earlier runs taught, and what the kernels' own documentation says: stored, found again, handed out as text."""
