"""LiteLLM: real models, of any provider that litellm knows, and any OpenAI-compatible endpoint.

The only `import litellm` of the package, done in the constructor: it takes seconds. Keys come from the provider's
environment variables; no key enters a request, a record, the trace or an error.
"""

from __future__ import annotations

import base64
import json
import os
import random
import re
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Final, TypeVar
from urllib.parse import urlsplit

import numpy as np

from articad.agents.llm import Image, Message, Reply, Request, Text, Usage, require_open_port, transport_error
from articad.errors import TransportError
from articad.memory.embedding import FloatArray, normalised

_Answer = TypeVar("_Answer")

Json = dict[str, Any]

DEFAULT_MODEL: Final = "gemini/gemini-3-flash-preview"  # the paper's backbone: it sees, keeps to schemas, and its price is known
TIMEOUT_S: Final = 600.0  # one answer; a thinking model writes a large plan in minutes
TRIES: Final = 6
FIRST_WAIT_S: Final = 1.0  # doubled after each try: 31 s in all
LONGEST_WAIT_S: Final = 60.0
_RETRIED_STATUS: Final = frozenset({408, 409, 425, 429, 500, 502, 503, 504, 529})
_LOOKING: Final = frozenset({"look", "observe"})  # roles that are nothing without sight
_LONGEST_ANSWER: Final = 4_000_000  # characters; the plan of a thousand parts has a tenth of that
_BATCH: Final = 64  # texts that are embedded at once; providers take about a hundred
_LONGEST_MARK: Final = 200  # characters
_SHOWN_CHARACTERS: Final = 300  # of a provider's own message
_LOCAL_HOSTS: Final = frozenset({"localhost", "127.0.0.1", "::1", "0.0.0.0", "host.docker.internal"})  # noqa: S104 - compared, never bound
_SECRET_NAME = re.compile(r"KEY|TOKEN|SECRET|PASSWORD|CREDENTIAL", re.IGNORECASE)
_SECRET_SHAPE = re.compile(r"(?i)\b(?:sk|pk|rk|key|api|gsk|xai|AIza)[-_][\w*.-]{6,}|\bbearer\s+[^\s,;]+|//[^/@\s]+:[^/@\s]+@")
_SHORTEST_SECRET = 6  # characters; shorter values of such variables are words like "none"
_TOLD: Final = "one JSON object and nothing else"  # stands in every prompt that tells the form of its answer
_FORM = (
    "Answer with one JSON object and nothing else: no Markdown fence, no text before or after it. "
    "It must be valid against this JSON schema:\n"
)


_SIGHT = "Name one that does with --vision-model, or do without: --no-look --no-inspection."


class _EmptyAnswerError(ValueError):
    """A completion without text: models do that now and then."""


class LiteLLM:
    """A model behind litellm.

    Args:
        model: In litellm's spelling, such as `gemini/gemini-3-flash`; with `api_base`, any name that the endpoint knows.
        api_base: Address of an OpenAI-compatible endpoint, such as `http://127.0.0.1:8000/v1`.
        models: Other models for some roles, by role.
        vision_model: Model for requests with pictures; `model` by default.
        judge_model: Model for the role "judge"; the same as `models={"judge": …}`.
        temperature: Left to the provider by default.
        timeout: Longest wait for one answer [s].
        tries: How often to ask when the provider is busy or out of reach.
        sleep: Waits; for tests.

    Raises:
        TransportError: `E_KEY_MISSING`, naming the environment variable, if the provider needs one that is not set.
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
        os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")  # else the import fetches a price list
        os.environ.setdefault("LITELLM_LOG", "ERROR")
        os.environ["LITELLM_MODE"] = "PRODUCTION"  # else the import loads the nearest .env, which may name another host for the user's key
        import litellm  # noqa: PLC0415 - seconds, and only for those who call a model

        litellm.suppress_debug_info = True
        litellm.telemetry = False
        self._litellm: Any = litellm
        self._api_base = api_base
        self._is_local = api_base is not None and urlsplit(api_base).hostname in _LOCAL_HOSTS
        self._model = self._qualified(model)
        self._models = {
            role: self._qualified(name) for role, name in (dict(models or {}) | ({"judge": judge_model} if judge_model else {})).items()
        }
        self._vision_model = self._qualified(vision_model) if vision_model else None
        self._temperature, self._timeout, self._tries, self._sleep = temperature, timeout, tries, sleep
        self._takes_no_schema: set[str] = set()
        self._blind: set[str] = set()
        for name in {self._model, *self._models.values(), *filter(None, [self._vision_model])}:
            self._require_key(name)

    def __repr__(self) -> str:
        return f"LiteLLM({self._model!r})"

    def model_for(self, request: Request) -> str:
        """Return the model that answers a request: its role's, else the one that sees, else the default."""
        if request.role in self._models:
            return self._models[request.role]
        return self._vision_model if self._vision_model and request.has_images else self._model

    def complete(self, request: Request) -> Reply:
        """Ask the model, again after a pause when it is busy.

        Raises:
            TransportError: If it cannot be reached, refuses, or its answer is no completion.
        """
        require_open_port()
        model = self.model_for(request)
        return self._patiently(model, lambda: self._asked(model, request))

    def vectors(self, texts: Sequence[str]) -> list[list[float]]:
        """Return the vector of each text, from a model for embeddings; the port may be closed: nothing is decided by them.

        Raises:
            TransportError: As `complete`.
        """
        batches = (list(texts[start : start + _BATCH]) for start in range(0, len(texts), _BATCH))
        return [vector for batch in batches for vector in self._patiently(self._model, partial(self._embedded, batch))]

    def _patiently(self, model: str, call: Callable[[], _Answer]) -> _Answer:
        """Call, again after a pause when the provider is busy."""
        for number in range(1, self._tries + 1):
            try:
                return call()
            except Exception as error:  # noqa: BLE001 - litellm raises what its providers raise
                failure = self._translated(error, model, number)
                if failure is not None:
                    raise failure from None  # the cause may hold the key in its text or its request
                self._sleep(_pause(error, number))
        raise AssertionError("the last try either answers or raises")

    @property
    def sees(self) -> bool:
        """Whether the model that gets pictures is known, or may be hoped, to see; an endpoint of one's own is asked."""
        return self._api_base is not None or self._sees(self._vision_model or self._model)

    def takes_schemas(self, model: str | None = None) -> bool:
        """Whether a model is held to a schema by its provider, rather than asked for the form in words."""
        name = self._qualified(model) if model else self._model
        return name not in self._takes_no_schema and (self._api_base is not None or self._supports_schema(name))

    # ------------------------------------------------------------------ one call

    def _arguments(self, model: str) -> Json:
        """Return what every call says."""
        arguments: Json = {"model": model, "timeout": self._timeout, "num_retries": 0, "max_retries": 0}
        if self._api_base is not None:
            arguments["api_base"] = self._api_base
        if self._is_local and not self._key_is_set(model):
            arguments["api_key"] = "local"  # the client library insists on one; a local endpoint reads none
        return arguments

    def _embedded(self, texts: list[str]) -> list[list[float]]:
        response = self._litellm.embedding(input=texts, **self._arguments(self._model))
        rows = sorted((dict(row) for row in response.data), key=lambda row: int(row["index"]))
        if len(rows) != len(texts):
            raise _EmptyAnswerError
        return [[float(number) for number in row["embedding"]] for row in rows]

    def _asked(self, model: str, request: Request) -> Reply:
        blind = model in self._blind or (self._api_base is None and request.has_images and not self._sees(model))
        if blind and request.role in _LOOKING:
            raise transport_error("E_TRANSPORT", f"{model} cannot see, and {request.step} is about pictures.", _SIGHT)
        arguments = self._arguments(model)
        arguments["messages"] = [_as_chat(_in_words(message) if blind else message) for message in request.messages]
        if self._temperature is not None:
            arguments["temperature"] = self._temperature
        if request.response_schema is not None:
            schema = dict(request.response_schema)
            if self.takes_schemas(model):
                form = {"name": request.role, "schema": schema}
                arguments["response_format"] = {"type": "json_schema", "json_schema": form}
            else:
                arguments["messages"] = _with_form(arguments["messages"], schema)
        try:
            response = self._litellm.completion(**arguments)
        except self._litellm.BadRequestError as error:
            if not self._learned(model, str(error), arguments, request, blind=blind):
                raise
            return self._asked(model, request)
        return self._read(response, model)

    def _learned(self, model: str, said: str, arguments: Json, request: Request, *, blind: bool) -> bool:
        """Note what a model does not take, from how it refused; return whether to ask again without it."""
        if "response_format" in arguments and re.search(r"response_format|schema", said):
            self._takes_no_schema.add(model)
            return True
        drawn = any(_is_drawn(part) for message in request.messages for part in message.parts)
        if drawn and not blind and re.search(r"image|vision|multimodal", said, re.IGNORECASE):
            self._blind.add(model)
            return True
        return False

    def _sees(self, model: str) -> bool:
        try:
            return bool(self._litellm.supports_vision(model=model))
        except Exception:  # noqa: BLE001 - an unknown model
            return False

    def _read(self, response: Any, model: str) -> Reply:
        text = response.choices[0].message.content
        if not isinstance(text, str) or not text.strip():
            raise _EmptyAnswerError
        if len(text) > _LONGEST_ANSWER:
            message = f"{model} answered with {len(text)} characters; {_LONGEST_ANSWER} are the most that are read."
            raise transport_error("E_TRANSPORT", message, "Name another model; no plan and no script is as long.")
        used = getattr(response, "usage", None)
        usage = Usage(*(max(int(getattr(used, name, 0) or 0), 0) for name in ("prompt_tokens", "completion_tokens")))
        marks = (getattr(response, "system_fingerprint", None), getattr(response, "model", None))  # the second says which version it was
        fingerprint = next((mark for mark in marks if isinstance(mark, str) and mark), None)
        return Reply(text, model, usage, self._cost(response, model), fingerprint and fingerprint[:_LONGEST_MARK])

    def _cost(self, response: Any, model: str) -> float | None:
        if self._api_base is not None:
            return None  # the endpoint's owner sets the price, whatever the model is called
        try:
            cost = self._litellm.completion_cost(completion_response=response, model=model)
        except Exception:  # noqa: BLE001 - of many kinds, and each means that the price is unknown
            return None
        return float(cost) if cost else None

    def _supports_schema(self, model: str) -> bool:
        try:
            return bool(self._litellm.supports_response_schema(model=model))
        except Exception:  # noqa: BLE001 - an unknown model
            return False

    # ------------------------------------------------------------------ names and keys

    def _qualified(self, model: str) -> str:
        """Return the model with its provider; behind `api_base` an unknown name is the endpoint's own."""
        try:
            self._litellm.get_llm_provider(model)
        except Exception:  # noqa: BLE001 - litellm's way to say that it does not know the provider
            if self._api_base is None:
                known = "openai/…, anthropic/…, gemini/…, mistral/…, ollama/…"
                message = f"Model {model!r} names no provider that litellm knows."
                raise transport_error("E_TRANSPORT", message, f"Write provider/model ({known}), or give --api-base.") from None
            return f"openai/{model}"
        return model

    def _variables(self, model: str) -> list[str]:
        """Return the environment variables that may hold the provider's key."""
        try:
            missing = self._litellm.validate_environment(model)["missing_keys"]
        except Exception:  # noqa: BLE001 - an unknown provider
            missing = []
        provider = model.split("/", maxsplit=1)[0] if "/" in model else self._litellm.get_llm_provider(model)[1]
        return list(missing) or [f"{provider.upper().replace('-', '_')}_API_KEY"]

    def _key_is_set(self, model: str) -> bool:
        try:
            return bool(self._litellm.validate_environment(model)["keys_in_environment"])
        except Exception:  # noqa: BLE001 - an unknown provider: its own answer will tell
            return True

    def _require_key(self, model: str) -> None:
        if not self._is_local and not self._key_is_set(model):
            raise self._key_error(model, "is not set")

    def _key_error(self, model: str, what: str) -> TransportError:
        names = " or ".join(self._variables(model))
        return transport_error("E_KEY_MISSING", f"The key for {model}, environment variable {names}, {what}.", f"Set {names}.")

    # ------------------------------------------------------------------ failures

    def _translated(self, error: Exception, model: str, number: int) -> TransportError | None:
        """Return the error to raise, or None to try again."""
        status = getattr(error, "status_code", None)
        if isinstance(error, TransportError):
            return error
        if isinstance(error, (self._litellm.AuthenticationError, self._litellm.PermissionDeniedError)) or status in (401, 403):
            return self._key_error(model, "was refused by the provider")
        out_of_reach = (self._litellm.APIConnectionError, self._litellm.Timeout, _EmptyAnswerError)
        if (status in _RETRIED_STATUS or isinstance(error, out_of_reach)) and number < self._tries:
            return None
        if isinstance(error, self._litellm.Timeout):
            what = f"did not answer within {self._timeout:g} s"
        elif isinstance(error, _EmptyAnswerError):
            what = "gave an empty answer"
        elif status is not None:
            what = f"failed with status {status}"
        else:
            what = "gave no usable answer"
        shown = without_secrets(str(error)).strip().splitlines() or [type(error).__name__]
        message = f"{model} {what}, asked {number} times: {shown[0][:_SHOWN_CHARACTERS]}"
        hint = "Check --api-base and the network." if self._api_base else "Check the network, the model's name and the provider's status."
        return transport_error("E_TRANSPORT", message, hint)


class LiteLLMEmbedder:
    """A provider's own vectors, for the experience store: nearer to what is meant than the offline ones, at its price.

    Args:
        model: A model for embeddings in litellm's spelling, such as `gemini/gemini-embedding-001`.
        api_base: As for `LiteLLM`.
    """

    def __init__(self, model: str, *, api_base: str | None = None) -> None:
        self._llm = LiteLLM(model, api_base=api_base)
        self.name = f"litellm {model}"

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, dimension).

        Raises:
            TransportError: If the provider cannot be reached.
        """
        return normalised(self._llm.vectors(texts) if texts else np.zeros((0, 1)))


def without_secrets(text: str) -> str:
    """Return text from outside without anything that is, or looks like, a key of this environment."""
    for name, value in os.environ.items():
        if _SECRET_NAME.search(name) and len(value) >= _SHORTEST_SECRET:
            text = text.replace(value, "[key]")
    return _SECRET_SHAPE.sub("[key]", text)


def _pause(error: Exception, number: int) -> float:
    """Return how long to wait after a failed try [s]: what the provider asks for, else twice the last time."""
    headers = getattr(error, "litellm_response_headers", None) or {}
    asked = str(headers.get("retry-after", ""))
    if re.fullmatch(r"\d+(\.\d+)?", asked):
        return min(float(asked), LONGEST_WAIT_S)
    wait: float = FIRST_WAIT_S * 2 ** (number - 1) * random.uniform(0.8, 1.2)  # noqa: S311 - spreads parallel retries
    return min(wait, LONGEST_WAIT_S)


def _is_drawn(part: Text | Image) -> bool:
    return isinstance(part, Image) and part.recipe is not None


def _in_words(message: Message) -> Message:
    """Return a message without the pictures that articad drew: they help, but the words beside them say enough."""
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
    """Add the form of the answer for a model that cannot be held to a schema; a prompt that tells it in prose is left alone."""
    if _TOLD in str(messages[0]["content"]):
        return messages
    told = _FORM + json.dumps(schema, ensure_ascii=False)
    first, *rest = messages
    if first["role"] == "system" and isinstance(first["content"], str):
        return [{"role": "system", "content": f"{first['content']}\n\n{told}"}, *rest]
    return [{"role": "system", "content": told}, *messages]
