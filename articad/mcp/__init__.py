"""articad's deterministic tools for coding agents, by the Model Context Protocol."""
