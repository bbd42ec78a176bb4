"""The plan: its form, its arithmetic, what it means, and what is wrong with it."""
