"""A connector together with the part that carries it: one side of a joint."""

from __future__ import annotations

from dataclasses import dataclass

from articad.connectors.connector import Connector


@dataclass(frozen=True)
class Attachment:
    """One side of a joint, as `part["hinge"]` returns it.

    Attributes:
        part: Name of the part.
        connector: The connector, in the part's own frame.
    """

    part: str
    connector: Connector
