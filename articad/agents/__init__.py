"""The agents: the only place that talks to models, through the port in `articad.agents.llm`.

`pipeline.py` has `generate`, `resume` and `replay`, `edit.py` has `edit`; `settings.py` their options. `line.py` is the order of the stages:
`requirements.py`, `brainstorm.py`, `design.py`, `part_builder.py` and `part_writer.py`, `inspection.py`, `rollback.py`, `review.py`.
`llm.py` is the port to models and its doubles; `live.py`, `calls.py` and `provider.py` ask real ones. `replies.py` parses and validates what
they answer. `prompts/` holds the words.
"""
