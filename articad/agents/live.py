"""LiteLLM: models of any provider that litellm supports, and any OpenAI-compatible endpoint.

Each call runs in a process of its own (`calls.py`), with a deadline and a memory limit, because an endpoint may be hostile. Keys come
from the provider's environment variables; no key enters a request, a record, the trace or an error.
"""

from __future__ import annotations

import base64
import json
import os
import random
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final
from urllib.parse import urlsplit

import numpy as np

from articad.agents.calls import DESCRIBE_S, Calls
from articad.agents.llm import Image, Message, Meter, Reply, Request, Text, Usage, require_open_port, transport_error
from articad.aliases import Json
from articad.errors import BudgetError, TransportError
from articad.memory.embedding import FloatArray, normalised

DEFAULT_MODEL: Final = "gemini/gemini-3-flash-preview"  # the paper's backbone: it accepts images and schemas, and its price is known
TIMEOUT_S: Final = 600.0  # for one answer; a thinking model writes a large plan in minutes
_WHOLE_S: Final = 10  # from here on, seconds are told without a fraction
TRIES: Final = 6
FIRST_WAIT_S: Final = 1.0  # doubled after each try: 31 s in all
LONGEST_WAIT_S: Final = 60.0
_RETRIED_STATUS: Final = frozenset({408, 409, 425, 429, 500, 502, 503, 504, 529})
_RETRIED_KINDS: Final = frozenset({"late", "unreachable", "empty", "lost"})
_FINAL_KINDS: Final = frozenset({"key", "elsewhere"})  # whatever status they have
_LOOKING: Final = frozenset({"look", "observe"})  # roles that make no sense without images
_LONGEST_ANSWER: Final = 4_000_000  # characters; the plan of a thousand parts has a tenth of that
_BATCH: Final = 64  # texts that are embedded at once; providers accept about a hundred
_LONGEST_MARK: Final = 200  # characters
_SHOWN_CHARACTERS: Final = 300  # of a provider's own message
_LOCAL_HOSTS: Final = frozenset({"localhost", "127.0.0.1", "::1", "0.0.0.0", "host.docker.internal"})  # noqa: S104 - compared, never bound
_SECRET_NAME = re.compile(r"KEY|TOKEN|SECRET|PASSWORD|CREDENTIAL", re.IGNORECASE)
_SECRET_SHAPE = re.compile(r"(?i)\b(?:sk|pk|rk|key|api|gsk|xai|AIza)[-_][\w*.-]{6,}|\bbearer\s+[^\s,;]+|//[^/@\s]+:[^/@\s]+@")
_BLANK = re.compile(r"[\x00-\x20\x7f]")  # characters that an address cannot hold, and that some parsers of addresses skip
_SHORTEST_SECRET = 6  # characters; shorter values of such variables are words like "none"
_TOLD: Final = "one JSON object and nothing else"  # every prompt that describes the form of its answer contains these words
_FORM = (
    "Answer with one JSON object and nothing else: no Markdown fence, no text before or after it. "
    "It must be valid against this JSON schema:\n"
)


_SIGHT = "Name one that does with --vision-model, or do without: --no-look --no-inspection."


class LiteLLM:
    """A model called through litellm.

    Args:
        model: In litellm's spelling, such as `gemini/gemini-3-flash`; with `api_base`, any name that the endpoint accepts.
        api_base: Address of an OpenAI-compatible endpoint, such as `http://127.0.0.1:8000/v1`.
        models: Other models for some roles, by role.
        vision_model: Model for requests with pictures; `model` by default.
        judge_model: Model for the role "judge"; the same as `models={"judge": …}`.
        temperature: Left to the provider by default.
        timeout: Longest time of one call, from its start to the last byte of its answer [s].
        tries: How often to ask when the provider is busy or unreachable.
        sleep: Function that waits; replaced in tests.

    Raises:
        TransportError: `E_KEY_MISSING`, naming the environment variable, if the provider needs one that is not set; `E_TRANSPORT` if
            models cannot be called on this machine, or `api_base` is not an address.
    """

    def __init__(
        self,
        model: str,
        *,
        api_base: str | None = None,
        models: Mapping[str, str] | None = None,
        vision_model: str | None = None,
        judge_model: str | None = None,
        temperature: float | None = None,
        timeout: float = TIMEOUT_S,
        tries: int = TRIES,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        if api_base is not None:
            _require_address(api_base)
        self._calls = Calls.shared()
        self._api_base = api_base
        self._is_local = api_base is not None and urlsplit(api_base).hostname in _LOCAL_HOSTS
        self._known: dict[str, Json] = {}  # litellm's data about each model, by qualified name
        self._model = self._qualified(model)
        self._models = {
            role: self._qualified(name) for role, name in (dict(models or {}) | ({"judge": judge_model} if judge_model else {})).items()
        }
        self._vision_model = self._qualified(vision_model) if vision_model else None
        self._temperature, self._timeout, self._tries, self._sleep = temperature, timeout, tries, sleep
        self._takes_no_schema: set[str] = set()
        self._blind: set[str] = set()
        self._sizes: set[int] = set()  # of the vectors that it gave
        for name in {self._model, *self._models.values(), *filter(None, [self._vision_model])}:
            if not self._is_local and not self._known[name]["has_key"]:
                raise self._key_error(name, "is not set")

    def __repr__(self) -> str:
        return f"LiteLLM({self._model!r})"

    def model_for(self, request: Request) -> str:
        """Return the model that answers a request: that of its role, else the vision model for pictures, else the default."""
        if request.role in self._models:
            return self._models[request.role]
        return self._vision_model if self._vision_model and request.has_images else self._model

    def complete(self, request: Request) -> Reply:
        """Ask the model; if it is busy, again after a pause.

        Raises:
            TransportError: If it cannot be reached, refuses, or its answer is not a completion.
        """
        return self.complete_within(request, Meter())

    def complete_within(self, request: Request, meter: Meter) -> Reply:
        """Ask as `complete` does, each try within the limits of a meter.

        Raises:
            TransportError: As `complete`.
            BudgetError: If the budget allows no further try.
        """
        require_open_port()
        model = self.model_for(request)
        while True:
            blind = self._is_blind(model, request)
            arguments = self._conversation(model, request, blind=blind)
            answer = self._patiently("complete", model, arguments, meter)
            if "error" not in answer:
                return self._read(answer, model)
            if not self._learned(model, answer["error"]["text"], arguments, request, blind=blind):
                raise self._failure(answer["error"], model, 1, self._timeout)

    def vectors(self, texts: Sequence[str], meter: Meter | None = None) -> list[list[float]]:
        """Return the vector of each text from an embedding model. A closed port does not forbid this: vectors decide nothing.

        Args:
            texts: The texts to embed.
            meter: Counts the calls and limits their time.

        Raises:
            TransportError: As `complete`; also if vectors have different sizes.
            BudgetError: If the budget allows no further call.
        """
        rows: list[list[float]] = []
        for start in range(0, len(texts), _BATCH):
            answer = self._patiently("embed", self._model, {}, meter or Meter(), texts=list(texts[start : start + _BATCH]))
            if "error" in answer:
                raise self._failure(answer["error"], self._model, 1, self._timeout)
            rows += answer["rows"]
        self._sizes |= {len(row) for row in rows}
        if len(self._sizes) > 1:
            raise self._sizes_differ()
        return rows

    def _sizes_differ(self) -> TransportError:
        message = f"{self._model} gave vectors of {min(self._sizes)} and of {max(self._sizes)} numbers."
        return transport_error("E_TRANSPORT", message, "Name another model for --embeddings.")

    @property
    def sees(self) -> bool:
        """Return whether the model for pictures accepts images, as litellm states; for an unknown endpoint this is assumed."""
        return self._api_base is not None or bool(self._known[self._vision_model or self._model]["sees"])

    def takes_schemas(self, model: str | None = None) -> bool:
        """Return whether the provider enforces a schema, rather than being asked for the form in words."""
        name = self._qualified(model) if model else self._model
        return name not in self._takes_no_schema and (self._api_base is not None or bool(self._known[name]["takes_schemas"]))

    # ------------------------------------------------------------------ one call

    def _patiently(self, do: str, model: str, arguments: Json, meter: Meter, **more: Any) -> Json:
        """Call, again after a pause if the provider is busy; return the answer, or the error if it rejects the form of the request.

        Raises:
            TransportError: If it fails, or stays busy.
            BudgetError: If the meter allows no further call.
        """
        arguments = {"model": model} | arguments | ({} if self._api_base is None else {"api_base": self._api_base})
        failed: TransportError | None = None
        for number in range(1, self._tries + 1):
            with _saying_why(failed):
                seconds = min(self._timeout, meter.begin())
            try:
                answer = self._calls.ask(do, seconds, arguments=arguments, is_local=self._is_local, **more)
            except OSError as error:
                raise _no_calls(error) from None
            failure = answer.get("error")
            if failure is None or failure["kind"] == "form":
                return answer
            failed = self._failure(failure, model, number, seconds)
            is_passing = failure["kind"] not in _FINAL_KINDS and (failure["kind"] in _RETRIED_KINDS or failure["status"] in _RETRIED_STATUS)
            pause = _pause(failure, number) if is_passing and number < self._tries else 0.0
            with _saying_why(failed):
                meter.require(pause)  # a call that was ended by the budget is reported as such
            if not is_passing or number == self._tries:
                raise failed
            self._sleep(pause)
        raise AssertionError("the last try either answers or raises")

    def _is_blind(self, model: str, request: Request) -> bool:
        """Return whether the pictures of a request are left out because the model accepts none; refuse a request about pictures."""
        blind = model in self._blind or (self._api_base is None and request.has_images and not self._known[model]["sees"])
        if blind and request.role in _LOOKING:
            raise transport_error("E_TRANSPORT", f"{model} cannot see, and {request.step} is about pictures.", _SIGHT)
        return blind

    def _conversation(self, model: str, request: Request, *, blind: bool) -> Json:
        """Return the messages of a request in chat format."""
        arguments: Json = {"messages": [_as_chat(_in_words(message) if blind else message) for message in request.messages]}
        if self._temperature is not None:
            arguments["temperature"] = self._temperature
        if request.response_schema is not None:
            schema = dict(request.response_schema)
            if self.takes_schemas(model):
                form = {"name": request.role, "schema": schema}
                arguments["response_format"] = {"type": "json_schema", "json_schema": form}
            else:
                arguments["messages"] = _with_form(arguments["messages"], schema)
        return arguments

    def _learned(self, model: str, said: str, arguments: Json, request: Request, *, blind: bool) -> bool:
        """Note from a refusal what a model does not accept; return whether to ask again without it."""
        if "response_format" in arguments and re.search(r"response_format|schema", said):
            self._takes_no_schema.add(model)
            return True
        drawn = any(_is_drawn(part) for message in request.messages for part in message.parts)
        if drawn and not blind and re.search(r"image|vision|multimodal", said, re.IGNORECASE):
            self._blind.add(model)
            return True
        return False

    def _read(self, answer: Json, model: str) -> Reply:
        text: str = answer["text"]
        if len(text) > _LONGEST_ANSWER:
            message = f"{model} answered with {len(text)} characters; {_LONGEST_ANSWER} is the maximum."
            raise transport_error("E_TRANSPORT", message, "Name another model; no plan or script is that long.")
        cost = None if self._api_base is not None else answer["cost"]  # the endpoint's owner sets the price, whatever name the model has
        fingerprint = answer["fingerprint"]
        return Reply(text, model, Usage(*answer["usage"]), cost, fingerprint and fingerprint[:_LONGEST_MARK])

    # ------------------------------------------------------------------ names and keys

    def _qualified(self, model: str) -> str:
        """Return the model with its provider; with `api_base`, an unknown name is one of the endpoint's own.

        Raises:
            TransportError: If litellm does not know the provider and there is no own endpoint, or litellm cannot be called.
        """
        if model not in self._known and f"openai/{model}" in self._known:
            return f"openai/{model}"
        if model in self._known:
            return model
        try:
            told = self._calls.ask("describe", DESCRIBE_S, models=[model, f"openai/{model}"])
        except OSError as error:
            raise _no_calls(error) from None
        if "error" in told:
            raise _no_calls(told["error"]["text"] or "it does not answer")
        name = model
        if told["models"][model]["provider"] is None:
            if self._api_base is None:
                known = "openai/…, anthropic/…, gemini/…, mistral/…, ollama/…"
                message = f"Model {model!r} does not name a provider that litellm supports."
                raise transport_error("E_TRANSPORT", message, f"Write provider/model ({known}), or give --api-base.")
            name = f"openai/{model}"
        self._known[name] = told["models"][name]
        return name

    def _variables(self, model: str) -> list[str]:
        """Return the environment variables that may hold the provider's key."""
        known = self._known[model]
        provider = model.split("/", maxsplit=1)[0] if "/" in model else known["provider"]
        return list(known["missing"]) or [f"{provider.upper().replace('-', '_')}_API_KEY"]

    def _key_error(self, model: str, what: str) -> TransportError:
        names = " or ".join(self._variables(model))
        return transport_error("E_KEY_MISSING", f"The key for {model}, environment variable {names}, {what}.", f"Set {names}.")

    # ------------------------------------------------------------------ failures

    def _failure(self, failure: Json, model: str, number: int, seconds: float) -> TransportError:
        """Return the error of a call that failed: its last attempt had so many seconds."""
        kind, status = failure["kind"], failure["status"]
        if kind == "key":
            return self._key_error(model, "was refused by the provider")
        if kind == "late":
            what = f"did not answer within {seconds:.{0 if seconds >= _WHOLE_S else 1}f} s"
        elif kind == "empty":
            what = "gave an empty answer"
        elif kind == "redirect":
            what = "sent the request on to another address, which is not followed"
        elif kind == "elsewhere":
            what = "is asked at another address than --api-base, which its provider ignores"
        elif kind == "body":
            what = "gave an unreadable answer"
        elif kind == "memory":
            what = "gave an answer that takes too much memory"
        elif status is not None:
            what = f"failed with status {status}"
        else:
            what = "gave no usable answer"
        shown = next(iter(without_secrets(failure["text"]).strip().splitlines()), "")[:_SHOWN_CHARACTERS].rstrip(".")
        message = f"{model} {what}, after {number} attempt{'' if number == 1 else 's'}{f': {shown}' if shown else ''}."
        hint = "Check --api-base and the network." if self._api_base else "Check the network, the model's name and the provider's status."
        return transport_error("E_TRANSPORT", message, hint)


class LiteLLMEmbedder:
    """Vectors from a provider for the experience store: closer in meaning than the offline ones, at the provider's price.

    Args:
        model: A model for embeddings in litellm's spelling, such as `gemini/gemini-embedding-001`.
        api_base: As for `LiteLLM`.
        meter: Counts the calls and limits their time.
    """

    def __init__(self, model: str, *, api_base: str | None = None, meter: Meter | None = None) -> None:
        self._llm, self._meter = LiteLLM(model, api_base=api_base), meter
        self.name = f"litellm {model}"

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, dimension).

        Raises:
            TransportError: If the provider cannot be reached.
            BudgetError: If the meter allows no further call.
        """
        return normalised(self._llm.vectors(texts, self._meter) if texts else np.zeros((0, 1)))


def _require_address(address: str) -> None:
    """Refuse a text that is not the address of an endpoint, before requests to it are tried and repeated.

    Raises:
        TransportError: If it is not http:// or https://, a host, and perhaps a port and a path.
    """
    try:
        stated = urlsplit(address)
        is_valid = stated.scheme in ("http", "https") and bool(stated.hostname) and stated.port != 0 and not _BLANK.search(address)
    except ValueError:  # brackets that do not close, a port that is no number
        is_valid = False
    if not is_valid:
        message = f"{without_secrets(address)!r} is not the address of an endpoint."
        raise transport_error("E_TRANSPORT", message, "Write it as http://127.0.0.1:8000/v1.")


@contextmanager
def _saying_why(failed: TransportError | None) -> Iterator[None]:
    """Add to the error of a spent budget why the last attempt failed, if there was one."""
    try:
        yield
    except BudgetError as error:
        raise error if failed is None else error.after(failed) from None


def _no_calls(problem: object) -> TransportError:
    """Return the error for a machine on which no model can be called."""
    return transport_error("E_TRANSPORT", f"No model can be called here: {problem}.", "Run articad doctor.")


def without_secrets(text: str) -> str:
    """Return text from outside with everything removed that is, or looks like, a key of this environment."""
    for name, value in os.environ.items():
        if _SECRET_NAME.search(name) and len(value) >= _SHORTEST_SECRET:
            text = text.replace(value, "[key]")
    return _SECRET_SHAPE.sub("[key]", text)


def _pause(failure: Json, number: int) -> float:
    """Return the pause after a failed try [s]: what the provider requests, else twice the last one."""
    asked = failure["retry_after"]
    if re.fullmatch(r"\d+(\.\d+)?", asked):
        return min(float(asked), LONGEST_WAIT_S)
    wait: float = FIRST_WAIT_S * 2 ** (number - 1) * random.uniform(0.8, 1.2)  # noqa: S311 - spreads parallel retries
    return min(wait, LONGEST_WAIT_S)


def _is_drawn(part: Text | Image) -> bool:
    return isinstance(part, Image) and part.recipe is not None


def _in_words(message: Message) -> Message:
    """Return a message without the pictures that articad drew: they help, but the text beside them suffices."""
    return Message(message.speaker, tuple(Text("(not shown)") if _is_drawn(part) else part for part in message.parts))


def _as_chat(message: Message) -> Json:
    if all(isinstance(part, Text) for part in message.parts):
        return {"role": message.speaker, "content": "\n\n".join(part.text for part in message.parts if isinstance(part, Text))}
    return {"role": message.speaker, "content": [_as_content(part) for part in message.parts]}


def _as_content(part: Text | Image) -> Json:
    if isinstance(part, Text):
        return {"type": "text", "text": part.text}
    return {"type": "image_url", "image_url": {"url": f"data:{part.media_type};base64,{base64.b64encode(part.content).decode()}"}}


def _with_form(messages: list[Json], schema: Json) -> list[Json]:
    """Add the form of the answer for a model that does not enforce a schema; a prompt that already describes it is left alone."""
    if _TOLD in str(messages[0]["content"]):
        return messages
    told = _FORM + json.dumps(schema, ensure_ascii=False)
    first, *rest = messages
    if first["role"] == "system" and isinstance(first["content"], str):
        return [{"role": "system", "content": f"{first['content']}\n\n{told}"}, *rest]
    return [{"role": "system", "content": told}, *messages]
