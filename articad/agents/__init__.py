"""The agents: the only place that talks to models, through the port in `articad.agents.llm`."""
