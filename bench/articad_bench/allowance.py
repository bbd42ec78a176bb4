"""What a run of a task may use: requests and characters are counted over all its stages, also when a killed run goes on."""

from __future__ import annotations

import threading
from collections.abc import Iterable

from articad.agents.llm import LLM, Reply, Request
from articad.aliases import Json
from articad.errors import BudgetError
from articad.findings import Finding
from articad_bench.task import TaskBudget


class Allowance:
    """The budget of one task at work.

    A request that would exceed it is not sent. An answer may exceed the characters, because nobody knows its length before; it is the last one.

    Args:
        budget: The limits; None for none.
        records: Of requests that were answered before a run was killed.

    Attributes:
        calls: Requests that were sent.
        characters: Of their texts, and of the answers'.
    """

    def __init__(self, budget: TaskBudget | None, records: Iterable[Json] = ()) -> None:
        self._budget = budget or TaskBudget()
        self._guard = threading.Lock()
        self.calls = self.characters = 0
        for record in records:
            self.calls += 1
            self.characters += _length(record) + len(record["reply"]["text"])

    def of(self, llm: LLM) -> LLM:
        """Return a model that answers within what is left."""
        return _Allowed(llm, self)

    def take(self, request: Request) -> None:
        """Count a request.

        Raises:
            BudgetError: If it would exceed the budget.
        """
        calls, characters, length = self._budget.calls, self._budget.characters, _length(request.to_json())
        spent = ""
        with self._guard:
            if calls is not None and self.calls >= calls:
                spent = f"The task allows {calls} calls; all were made."
            elif characters is not None and self.characters + length > characters:
                spent = f"The task allows {characters} characters; {self.characters} were used, and this request has {length}."
            else:
                self.calls += 1
                self.characters += length
        if spent:
            finding = Finding(code="E_BUDGET", where=f"llm.{request.step}", message=spent, hint="The budget belongs to the task.")
            raise BudgetError(f"{spent} {request.step!r} was not answered.", spent=spent, findings=[finding])

    def answered(self, reply: Reply) -> None:
        """Count an answer."""
        with self._guard:
            self.characters += len(reply.text)


class _Allowed:
    def __init__(self, llm: LLM, allowance: Allowance) -> None:
        self._llm, self._allowance = llm, allowance

    def complete(self, request: Request) -> Reply:
        """Answer, if the budget allows it."""
        self._allowance.take(request)
        reply = self._llm.complete(request)
        self._allowance.answered(reply)
        return reply


def _length(request: Json) -> int:
    """Return the number of characters of a request's texts; pictures have none."""
    return sum(len(part.get("text", "")) for message in request["messages"] for part in message["content"])
