"""An open benchmark: tasks with deterministic checks, the metrics of the field, runners, and datasets made at scale."""
