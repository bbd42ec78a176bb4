"""Retrieval: what the agents ask of earlier runs and of the kernels' documentation.

The agents depend on these protocols only. By default nothing is retrieved, and a request for which nothing was retrieved has the same
key as one made without a store.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from articad.agents.llm import LLM
from articad.agents.requirements import Requirements


@dataclass(frozen=True)
class Recalled:
    """Cases of earlier runs for a designer.

    Attributes:
        heuristics: From runs that ended well: what to do.
        constraints: From runs that ended with a measured defect: what to avoid.
    """

    heuristics: Sequence[str] = ()
    constraints: Sequence[str] = ()


class Memory(Protocol):
    """Experience: designers see good and bad runs, authors of scripts only good ones."""

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:
        """Return cases that help to design a product."""
        ...

    def for_part(self, specification: str, kernel: str) -> Sequence[str]:
        """Return worked examples of similar parts: specification and script, never from a run that ended badly."""
        ...


class Documentation(Protocol):
    """Signatures and snippets of a kernel's own API."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:
        """Return documentation for a part's script; may ask the model, at steps `docs/<name>`, which names it would use."""
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
    """Has nothing beyond the prompts."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:  # noqa: ARG002 - the protocol's
        """Return nothing."""
        return ()


def listed_cases(title: str, cases: Sequence[str]) -> str:
    """Return cases as a section of a prompt; empty if there are none."""
    return "" if not cases else "\n\n".join(["", title, *cases])
