"""Retrieval: what earlier runs and the kernels' documentation have to say, as the agents ask for it.

The agents know these protocols only. What they are given by default remembers nothing, and a request that retrieved
nothing is the same, to its key, as one that was made without a store.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from articad.agents.llm import LLM
from articad.agents.requirements import Requirements


@dataclass(frozen=True)
class Recalled:
    """What a designer is told of earlier runs.

    Attributes:
        heuristics: Of runs that ended well: what to do.
        constraints: Of runs that ended with a measured defect: what to avoid.
    """

    heuristics: Sequence[str] = ()
    constraints: Sequence[str] = ()


class Memory(Protocol):
    """Experience: designers are told of good and bad runs, modellers of good ones only."""

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:
        """Return what helps to design a product."""
        ...

    def for_part(self, specification: str, kernel: str) -> Sequence[str]:
        """Return worked examples of parts alike: specification and script, never of a run that ended badly."""
        ...


class Documentation(Protocol):
    """Signatures and snippets of a kernel's own API."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:
        """Return what helps to write a part's script; may ask the model, at steps `docs/<name>`, which names it would use."""
        ...


class NoMemory:
    """Remembers nothing."""

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:  # noqa: ARG002 - the protocol's
        """Return nothing."""
        return Recalled()

    def for_part(self, specification: str, kernel: str) -> Sequence[str]:  # noqa: ARG002 - the protocol's
        """Return nothing."""
        return ()


class NoDocumentation:
    """Knows nothing beyond the prompts."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:  # noqa: ARG002 - the protocol's
        """Return nothing."""
        return ()


def listed_cases(title: str, cases: Sequence[str]) -> str:
    """Return cases as a section of a prompt; of none, nothing at all."""
    return "" if not cases else "\n\n".join(["", title, *cases])
