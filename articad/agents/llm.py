"""The interface to language models, and its test doubles: scripted, recorded, replayed, limited by a budget.

A request is addressed by its `step` in the run and verified by its `key`. The doubles are for users too: a run directory is its own
recording, and a script of replies makes every path of the agents testable without a model. Forms: `docs/reference/run.md`.
"""

from __future__ import annotations

import difflib
import fnmatch
import hashlib
import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Final, Literal, Protocol, runtime_checkable

from articad.aliases import Json
from articad.errors import BudgetError, ReadError, ReplayMissError, TransportError
from articad.findings import Finding, Findings
from articad.runs.run import Run, canonical_json, digest

Speaker = Literal["system", "user", "assistant"]

RECORD_SCHEMA: Final = "articad.llm/1"


# ---------------------------------------------------------------------- requests and replies


@dataclass(frozen=True)
class Text:
    """Text in a message."""

    text: str

    def to_json(self) -> Json:
        """Return the form that enters the key and the record."""
        return {"type": "text", "text": self.text}


@dataclass(frozen=True)
class Image:
    """A picture in a message.

    Attributes:
        source: The bytes of the file, or a function that draws them when they are needed: a replay draws no picture.
        media_type: "image/png" and the like.
        recipe: How articad drew it (digests, views, options, version of the recipe), JSON; None if the user gave it. A drawn picture
            enters the key by its recipe, because its pixels differ between machines.
    """

    source: bytes | Callable[[], bytes] = field(repr=False)
    media_type: str = "image/png"
    recipe: Mapping[str, Any] | None = None

    @cached_property
    def content(self) -> bytes:
        """The bytes of the file."""
        return self.source() if callable(self.source) else self.source

    def to_json(self) -> Json:
        """Return the form that enters the key and the record."""
        if self.recipe is not None:
            return {"type": "image", "recipe": dict(self.recipe)}
        return {"type": "image", "sha256": hashlib.sha256(self.content).hexdigest()}


@dataclass(frozen=True)
class Message:
    """One message: text and pictures, in order."""

    speaker: Speaker
    parts: tuple[Text | Image, ...]

    def to_json(self) -> Json:
        """Return the form that enters the key and the record."""
        return {"role": self.speaker, "content": [part.to_json() for part in self.parts]}


def system(text: str) -> Message:
    """Return the system message, which describes the role and its task."""
    return Message("system", (Text(text),))


def user(*parts: str | Image) -> Message:
    """Return a message to the model."""
    return Message("user", tuple(Text(part) if isinstance(part, str) else part for part in parts))


def assistant(text: str) -> Message:
    """Return an earlier reply of the model."""
    return Message("assistant", (Text(text),))


@dataclass(frozen=True)
class Request:
    """A question to a model.

    Attributes:
        role: Which agent asks: "requirements", "design", "part".
        step: Its address in the run, such as `part/lid/2`.
        messages: The conversation so far.
        response_schema: JSON schema that the reply must have; None for free text.
    """

    role: str
    step: str
    messages: tuple[Message, ...]
    response_schema: Mapping[str, Any] | None = None

    def to_json(self) -> Json:
        """Return the data that the key is computed from: it does not depend on the model, the time or the machine."""
        return {
            "role": self.role,
            "step": self.step,
            "messages": [message.to_json() for message in self.messages],
            "response_schema": None if self.response_schema is None else dict(self.response_schema),
        }

    @cached_property
    def key(self) -> str:
        """The sha256 of the request's canonical JSON."""
        return digest(self.to_json())

    @property
    def has_images(self) -> bool:
        """Whether the model must accept images."""
        return any(isinstance(part, Image) for message in self.messages for part in message.parts)


@dataclass(frozen=True)
class Usage:
    """Tokens in and out."""

    input_tokens: int = 0
    output_tokens: int = 0

    @property
    def total(self) -> int:
        """Sum of both."""
        return self.input_tokens + self.output_tokens


@dataclass(frozen=True)
class Reply:
    """A model's answer.

    Attributes:
        text: Its content.
        model: The model that answered.
        usage: Tokens.
        cost: In US dollars; None when the price is unknown, which is not zero.
        fingerprint: The provider's identifier of the system that answered, if it gives one.
    """

    text: str
    model: str
    usage: Usage = Usage()
    cost: float | None = None
    fingerprint: str | None = None

    def to_json(self) -> Json:
        """Return the recorded form."""
        return {
            "text": self.text,
            "model": self.model,
            "usage": {"input_tokens": self.usage.input_tokens, "output_tokens": self.usage.output_tokens},
            "cost": self.cost,
            "fingerprint": self.fingerprint,
        }

    @classmethod
    def from_json(cls, stored: Mapping[str, Any]) -> Reply:
        """Return the reply stored in a record.

        Raises:
            ReadError: If it does not have the right form.
        """
        try:
            used, cost = stored["usage"], stored["cost"]
            usage = Usage(_count(used["input_tokens"]), _count(used["output_tokens"]))
            texts = [stored["text"], stored["model"], stored["fingerprint"] or ""]
            if all(isinstance(text, str) for text in texts) and (cost is None or isinstance(cost, int | float)):
                return cls(stored["text"], stored["model"], usage, cost, stored["fingerprint"])
        except (KeyError, TypeError, ValueError):
            pass
        message = "A recorded reply is incomplete."
        finding = Finding(code="E_READ", where="llm", message=message, hint="Delete its file; the question is then asked again.")
        raise ReadError(message, path="llm", findings=[finding])


class LLM(Protocol):
    """Whatever answers requests. Several threads call it at once."""

    def complete(self, request: Request) -> Reply:
        """Answer a request.

        Raises:
            AgentError: If there is no answer.
        """
        ...


class Meter:
    """What a request may still use. This one counts nothing and has no limit; the meter of a `Budget` does both."""

    def begin(self) -> float:
        """Count one call that is about to be made, and return how long it may take [s].

        Raises:
            BudgetError: If the budget allows no call.
        """
        return math.inf

    def require(self, seconds: float) -> None:
        """Check that a pause and a call after it are within the limits.

        Args:
            seconds: The length of the pause.

        Raises:
            BudgetError: If they are not.
        """


@runtime_checkable
class MeteredLLM(LLM, Protocol):
    """A model that may make several calls for one request, and asks the meter before each."""

    def complete_within(self, request: Request, meter: Meter) -> Reply:
        """Answer within the limits of a meter.

        Raises:
            AgentError: If there is no answer.
        """
        ...


# ---------------------------------------------------------------------- the kill switch


_closed_because: ContextVar[str | None] = ContextVar("_closed_because", default=None)


@contextmanager
def closed_port(reason: str) -> Iterator[None]:
    """Refuse live calls from this thread until the block ends.

    Assembly and checks run in such a block, which enforces that they are deterministic. Other runs in the same process continue.
    """
    token = _closed_because.set(reason)
    try:
        yield
    finally:
        _closed_because.reset(token)


def require_open_port() -> None:
    """Raise if live calls are forbidden now; adapters of real models call this first.

    Raises:
        TransportError: If a `closed_port` block is running.
    """
    reason = _closed_because.get()
    if reason is not None:
        raise transport_error("E_TRANSPORT", f"No model may be called now: {reason}.", "Use Scripted or Replay here.")


def transport_error(code: str, message: str, hint: str) -> TransportError:
    """Return the error of a model that cannot be asked, with its finding."""
    return TransportError(f"{message} {hint}", findings=[Finding(code=code, where="llm", message=message, hint=hint)])


# ---------------------------------------------------------------------- doubles


Answer = str | Reply | Callable[[Request], "str | Reply"]


class Scripted:
    """Answers from a script: a step, or a pattern of steps such as `part/*/1`, maps to a reply or a function of the request.

    Attributes:
        requests: The requests, in order of arrival.
    """

    def __init__(self, answers: Mapping[str, Answer | Sequence[Answer]], *, model: str = "scripted") -> None:
        self.requests: list[Request] = []
        self._answers = dict(answers)
        self._model = model
        self._guard = threading.Lock()

    @property
    def steps(self) -> list[str]:
        """The steps of the requests, in order of arrival."""
        return [request.step for request in self.requests]

    def complete(self, request: Request) -> Reply:
        """Answer from the script; an exact step has priority over a pattern.

        Raises:
            ReplayMissError: If the script has no answer to this step.
        """
        with self._guard:
            self.requests.append(request)
        known = self._answers
        pattern = request.step if request.step in known else next((p for p in known if fnmatch.fnmatchcase(request.step, p)), None)
        if pattern is None:
            raise _miss("The script", request, known)
        answer = known[pattern]
        if isinstance(answer, Sequence) and not isinstance(answer, str):
            with self._guard:
                asked = sum(fnmatch.fnmatchcase(step, pattern) for step in self.steps)
            answer = answer[min(asked, len(answer)) - 1]
        said = answer(request) if callable(answer) else answer
        return Reply(said, self._model) if isinstance(said, str) else said


class Recorded:
    """Stores every reply in the run and reuses those that the run already has: a resumed run repeats no call."""

    def __init__(self, llm: LLM, run: Run) -> None:
        self._llm = llm
        self._run = run

    def complete(self, request: Request) -> Reply:
        """Answer from the run if it holds this very request, else ask and record."""
        stored = self._run.reply(request.step)
        if stored is not None and stored.get("key") == request.key:
            return Reply.from_json(stored.get("reply") or {})
        began = time.monotonic()
        reply = self._llm.complete(request)
        self._run.save_reply(request.step, {"schema": RECORD_SCHEMA, "key": request.key} | request.to_json() | {"reply": reply.to_json()})
        self._run.trace(
            "call",
            step=request.step,
            model=reply.model,
            fingerprint=reply.fingerprint,
            answer=hashlib.sha256(reply.text.encode()).hexdigest(),
            seconds=round(time.monotonic() - began, 3),
            tokens=reply.usage.total,
            cost="unknown" if reply.cost is None else reply.cost,
        )
        return reply


class Replay:
    """Answers from a recorded run, by step: no key, no network.

    Attributes:
        run: The recording, opened for reading.
    """

    def __init__(self, run: Run | str | Path, *, strict: bool = False) -> None:
        self.run = run if isinstance(run, Run) else Run.view(run)
        self._strict = strict
        self._drift: list[Finding] = []
        self._guard = threading.Lock()

    @property
    def findings(self) -> Findings:
        """A finding for each prompt that differs from the recorded one."""
        return Findings(self._drift)

    def complete(self, request: Request) -> Reply:
        """Answer as recorded.

        Raises:
            ReplayMissError: If the run has no reply to this step, or, when strict, to another prompt.
        """
        stored = self.run.reply(request.step)
        if stored is None:
            raise _miss("The recording", request, self.run.replies())
        if stored.get("key") != request.key:
            where = _first_difference(stored, request)
            message = f"The prompt of {request.step} is not the recorded one: {where}."
            if self._strict:
                finding = Finding(code="E_REPLAY_MISS", where=f"llm.{request.step}", message=message, hint="Record again.")
                raise ReplayMissError(message, step=request.step, nearest=request.step, findings=[finding])
            with self._guard:
                self._drift.append(
                    Finding(
                        code="I_PROMPT_DRIFT",
                        where=f"llm.{request.step}",
                        message=message,
                        hint="The recorded reply was used; record again, or replay strictly to refuse.",
                    )
                )
        return Reply.from_json(stored.get("reply") or {})


class Budget:
    """Asks until a budget is used up; checked before each call, so that the limit is not exceeded by a call.

    Each try of a `MeteredLLM` counts as a call, and may take what is left of the minutes.

    Args:
        llm: The model.
        calls: Largest number of calls.
        tokens: Largest number of tokens, in and out together.
        cost: Largest cost in US dollars. If a model's price is unknown, the call after its first is refused.
        minutes: Longest time since this object was made.
        clock: Returns seconds; monotonic.
    """

    def __init__(
        self,
        llm: LLM,
        *,
        calls: int | None = None,
        tokens: int | None = None,
        cost: float | None = None,
        minutes: float | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._llm = llm
        self._limits = (calls, tokens, cost, minutes)
        self._clock = clock
        self._began = clock()
        self._guard = threading.Lock()
        self.calls = 0
        self.tokens = 0
        self.cost = 0.0
        self.cost_unknown_of: str | None = None

    def complete(self, request: Request) -> Reply:
        """Ask, if the budget allows it.

        Raises:
            BudgetError: If it does not.
        """
        meter = self.meter(request.step)
        if isinstance(self._llm, MeteredLLM):
            reply = self._llm.complete_within(request, meter)
        else:
            meter.begin()
            reply = self._llm.complete(request)
        with self._guard:
            # numbers from an endpoint may be wrong, but can only add to what was used
            self.tokens += max(reply.usage.input_tokens, 0) + max(reply.usage.output_tokens, 0)
            if reply.cost is None or not math.isfinite(reply.cost):
                self.cost_unknown_of = reply.model
            else:
                self.cost += max(reply.cost, 0.0)
        return reply

    def meter(self, step: str) -> Meter:
        """Return the meter of a request.

        Args:
            step: The request's address, for the error.
        """
        return _BudgetMeter(self, step)

    def begin(self, step: str) -> float:
        """Count one call and return how long it may take [s]; see `Meter.begin`."""
        left = self._left()
        with self._guard:
            spent = self._spent(left)
            if spent is not None:
                raise self._error(spent, step)
            self.calls += 1
        return left

    def require(self, seconds: float, step: str) -> None:
        """Check that a pause and a call after it are within the limits; see `Meter.require`.

        Args:
            seconds: The length of the pause.
            step: Address of the request that calls.

        Raises:
            BudgetError: If they are not.
        """
        left = self._left()
        with self._guard:
            spent = self._spent(left)
        if spent is None and seconds >= left:
            spent = f"The budget of {self._limits[3]:g} minutes has {left:.0f} s left, but the next attempt is due in {seconds:.0f} s."
        if spent is not None:
            raise self._error(spent, step)

    def _left(self) -> float:
        minutes = self._limits[3]
        return math.inf if minutes is None else 60 * minutes - (self._clock() - self._began)

    def _error(self, spent: str, step: str) -> BudgetError:
        hint = "Raise the limit and resume the run." if self._priced else "Limit calls or tokens instead of the cost, and resume the run."
        finding = Finding(code="E_BUDGET", where=f"llm.{step}", message=spent, hint=hint)
        return BudgetError(f"{spent} {step!r} was not answered.", spent=spent, findings=[finding])

    @property
    def _priced(self) -> bool:
        """Whether a limit of cost, if there is one, can be enforced."""
        return self._limits[2] is None or self.cost_unknown_of is None

    def _spent(self, left: float) -> str | None:
        calls, tokens, cost, minutes = self._limits
        if calls is not None and self.calls >= calls:
            return f"The budget of {calls} calls is spent."
        if tokens is not None and self.tokens >= tokens:
            return f"The budget of {tokens} tokens is spent: {self.tokens} were used."
        if cost is not None and self.cost >= cost:
            return f"The budget of ${cost:g} is spent: ${self.cost:.4f} were used."
        if not self._priced:
            return f"The price of {self.cost_unknown_of} is unknown, so a budget of ${cost:g} cannot be enforced."
        if left <= 0:
            return f"The budget of {minutes:g} minutes is spent."
        return None


@dataclass(frozen=True)
class _BudgetMeter(Meter):
    """The meter of one request under a budget."""

    budget: Budget
    step: str

    def begin(self) -> float:
        return self.budget.begin(self.step)

    def require(self, seconds: float) -> None:
        self.budget.require(seconds, self.step)


def _count(value: object) -> int:
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    raise ValueError(value)


def _miss(who: str, request: Request, known: Mapping[str, Any] | Sequence[str]) -> ReplayMissError:
    steps = sorted(known)
    nearest = next(iter(difflib.get_close_matches(request.step, steps, n=1, cutoff=0.3)), None)
    message = f"{who} has no reply to {request.step!r} (role {request.role}); the nearest step is {nearest!r}."
    finding = Finding(code="E_REPLAY_MISS", where=f"llm.{request.step}", message=message, hint=f"It has: {', '.join(steps) or 'none'}.")
    return ReplayMissError(message, step=request.step, nearest=nearest, findings=[finding])


def _first_difference(stored: Mapping[str, Any], request: Request) -> str:
    """Say where a prompt first differs from the recorded one."""
    now = request.to_json()
    for name in ("role", "response_schema"):
        if canonical_json(stored.get(name)) != canonical_json(now[name]):
            return f"its {name.replace('_', ' ')} differs"
    before = stored.get("messages")
    if not isinstance(before, list) or len(before) != len(now["messages"]):
        return f"it has {len(now['messages'])} messages, not {len(before) if isinstance(before, list) else 0}"
    number = next((n for n, (a, b) in enumerate(zip(before, now["messages"], strict=True), 1) if a != b), 0)
    return f"message {number} differs"
