"""The process that talks to models. It imports LiteLLM once and forks a process with limits for each call. Started by `calls.py`.

A call is one connected socket, passed over stdin. The forked process
- reads one JSON object to the end of the stream: `do`, `seconds`, `environment`, and the arguments of the task;
- is killed by the kernel when `seconds` have passed (`ITIMER_REAL`: a monotonic clock), whatever it waits for;
- may allocate `MEMORY` bytes in addition to what the import and the request took;
- asks no other host over HTTP than that of a stated `api_base`, and none to describe models; the libraries would look up models and tokenizers elsewhere;
- follows no redirect, and reads at most `LARGEST_BODY` bytes, decompressed, in small pieces;
- answers with one JSON object, or dies, in which case its socket ends without an answer.

Tasks: `describe` models, `complete` a conversation, `embed` texts. The answer to a call that fails is `{"error": {...}}` with a `kind`:
`key`, `form`, `late`, `unreachable`, `empty`, `redirect`, `elsewhere`, `body`, `memory` or `other`.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import importlib
import json
import math
import os
import signal
import socket
import sys
import zlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final, NoReturn

from articad.aliases import Json

LARGEST_BODY: Final = 8 * 2**20  # bytes of an answer, as sent and decompressed: twice the longest text that is accepted
MEMORY: Final = 224 * 2**20  # bytes of private data that a call may add to what the import took
_MOST_TOKENS: Final = 10**12  # of one call; a sum of larger numbers may have too many digits to be printed
_MOST_NUMBERS: Final = 16_384  # of one vector; models give up to a few thousand
_PER_BYTE: Final = 8  # copies of a request that the client libraries may hold
_EARLY: Final = (
    "httpcore",
    "openai.resources.chat",
    "openai.resources.embeddings",
    "litellm.llms.openai.openai",
    "litellm._service_logger",
)
"""Modules that the first call would import: 1.5 s that each forked process would spend again."""
_SETTINGS: Final = {
    "LITELLM_LOCAL_MODEL_COST_MAP": "True",  # otherwise the import fetches a price list
    "LITELLM_LOCAL_ANTHROPIC_BETA_HEADERS": "True",  # otherwise a call of Bedrock fetches a list of headers
    "LITELLM_LOG": "ERROR",  # otherwise requests are printed
    "LITELLM_MODE": "PRODUCTION",  # otherwise the import loads the nearest .env, which may name another host for the user's key
    "HF_HUB_OFFLINE": "1",  # otherwise tokenizers are fetched to count the tokens of models with certain names
}
_OF_A_PROVIDER: Final = ("LITELLM_PROXY_API_BASE", "LITELLM_PROXY_API_KEY")  # a user's own endpoint, and its key
_PIECE: Final = 65536  # bytes that are decompressed at once
_PR_SET_PDEATHSIG: Final = 1
_TOO_LARGE: Final = f"its answer is longer than {LARGEST_BODY} bytes"
_GZIP_OR_ZLIB: Final = 32 + zlib.MAX_WBITS


class BodyError(Exception):
    """A body that is not read to its end."""


class ElsewhereError(Exception):
    """A request to another host than the one that is stated."""


class EmptyAnswerError(ValueError):
    """A completion without text, which models give now and then."""


def main() -> None:
    """Serve calls until stdin closes."""
    litellm = load()
    control = socket.socket(fileno=os.dup(0))
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for a call: its socket says how it ended
    parent = os.getpid()
    gc.freeze()  # the forked processes share the imported modules
    control.send(b"ready")
    while True:
        message, files, _, _ = socket.recv_fds(control, 16, 1)
        if not message:
            return
        if os.fork() == 0:
            control.close()
            _become(litellm, socket.socket(fileno=files[0]), parent)
        for file in files:
            os.close(file)


def load() -> Any:
    """Import LiteLLM with its telemetry, its downloads and its reading of `.env` files turned off, and limit what it reads."""
    _become_environment(os.environ.copy())
    import litellm  # noqa: PLC0415 - only in the process that calls models

    litellm.suppress_debug_info = True
    litellm.telemetry = False
    for name in _EARLY:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    _bound_transport()
    return litellm


def _become_environment(variables: Mapping[str, str]) -> None:
    """Replace the environment of this process. Of LiteLLM's own variables it keeps what a provider needs, and sets those of `_SETTINGS`."""
    kept = {name: value for name, value in variables.items() if not name.startswith("LITELLM_") or name in _OF_A_PROVIDER}
    os.environ.clear()
    os.environ.update(kept | _SETTINGS)


# ---------------------------------------------------------------------- one call, in a process of its own


def _become(litellm: Any, line: socket.socket, parent: int) -> NoReturn:
    """Carry out the request that the socket brings, answer, and exit."""
    try:
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0) if sys.platform == "linux" else None
        if os.getppid() != parent:
            os._exit(1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, 60.0)  # for the request to arrive
        with line.makefile("rb") as stream:
            told = stream.read()
        order = json.loads(told)
        signal.setitimer(signal.ITIMER_REAL, order["seconds"])
        _limit_memory(MEMORY + _PER_BYTE * len(told))
        _become_environment(order["environment"])
        with contextlib.redirect_stdout(sys.stderr):
            answer = _answer(litellm, order)
        line.sendall(json.dumps(answer, ensure_ascii=False).encode(errors="replace"))  # no file holds half of a surrogate pair
    except MemoryError:
        with contextlib.suppress(BaseException):
            line.sendall(b'{"error": {"kind": "memory"}}')
    except BaseException:  # noqa: BLE001, S110 - an end without an answer means that it failed
        pass
    finally:
        os._exit(0)


def _limit_memory(more: int) -> None:
    """Limit the private data of this process to its present size plus `more` (Linux only; macOS has no such limit)."""
    import resource  # noqa: PLC0415 - Windows has none

    with contextlib.suppress(OSError), open("/proc/self/status") as status:  # noqa: PTH123 - no pathlib is needed for it
        kilobytes = next(int(line.split()[1]) for line in status if line.startswith("VmData:"))
        resource.setrlimit(resource.RLIMIT_DATA, (kilobytes * 1024 + more,) * 2)


def _answer(litellm: Any, order: Json) -> Json:
    tasks: dict[str, Callable[[Any, Json], Json]] = {"describe": _describe, "complete": _complete, "embed": _embed}
    try:
        _keep_to("" if order["do"] == "describe" else order["arguments"].get("api_base"))
        return tasks[order["do"]](litellm, order)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - litellm raises what its providers raise
        return {"error": _failure(litellm, error)}


def _describe(litellm: Any, order: Json) -> Json:
    """Return for each model: its provider, the variables of its key, whether they are set, whether it accepts images and schemas."""
    return {"models": {name: _description(litellm, name) for name in order["models"]}}


def _description(litellm: Any, name: str) -> Json:
    try:
        provider = str(litellm.get_llm_provider(name)[1])
    except Exception:  # noqa: BLE001 - litellm's way to say that it does not know the provider
        provider = None
    told = _tried(lambda: litellm.validate_environment(name), {"missing_keys": [], "keys_in_environment": True})
    return {
        "provider": provider,
        "missing": [str(variable) for variable in told["missing_keys"]],
        "has_key": bool(told["keys_in_environment"]),  # an unknown provider counts as having one: its own answer will show
        "sees": bool(_tried(lambda: litellm.supports_vision(model=name), fallback=False)),
        "takes_schemas": bool(_tried(lambda: litellm.supports_response_schema(model=name), fallback=False)),
    }


def _complete(litellm: Any, order: Json) -> Json:
    model = order["arguments"]["model"]
    response = litellm.completion(**_arguments(litellm, order))
    text = response.choices[0].message.content
    if not isinstance(text, str) or not text.strip():
        raise EmptyAnswerError
    used = getattr(response, "usage", None)
    marks = (getattr(response, "system_fingerprint", None), getattr(response, "model", None))  # the second names the version
    cost = _tried(lambda: litellm.completion_cost(completion_response=response, model=model), fallback=None)
    return {
        "text": text,
        "usage": [min(max(int(getattr(used, name, 0) or 0), 0), _MOST_TOKENS) for name in ("prompt_tokens", "completion_tokens")],
        "cost": float(cost) if cost else None,
        "fingerprint": next((mark for mark in marks if isinstance(mark, str) and mark), None),
    }


def _embed(litellm: Any, order: Json) -> Json:
    response = litellm.embedding(input=order["texts"], **_arguments(litellm, order))
    rows = sorted((dict(row) for row in response.data), key=lambda row: int(row["index"]))
    if len(rows) != len(order["texts"]):
        raise EmptyAnswerError
    if not all(0 < len(row["embedding"]) <= _MOST_NUMBERS for row in rows):
        raise BodyError(f"its vectors do not have between 1 and {_MOST_NUMBERS} numbers")
    vectors = [[float(number) for number in row["embedding"]] for row in rows]
    if not all(math.isfinite(number) for vector in vectors for number in vector):
        raise BodyError("its vectors hold numbers that are not finite")
    return {"rows": vectors}


def _arguments(litellm: Any, order: Json) -> Json:
    """Return the arguments of a call. A local endpoint reads no key, but the client library requires one."""
    arguments = {"timeout": order["seconds"], "num_retries": 0, "max_retries": 0} | order["arguments"]
    has_key = _tried(lambda: litellm.validate_environment(arguments["model"])["keys_in_environment"], fallback=True)
    complete: Json = arguments | ({} if has_key or not order["is_local"] else {"api_key": "local"})
    return complete


def _failure(litellm: Any, error: Exception) -> Json:
    """Return the description of a failed call."""
    status = getattr(error, "status_code", None)
    status = status if isinstance(status, int) else None
    causes = list(_causes(error))
    own = next((cause for cause in causes if isinstance(cause, (BodyError, ElsewhereError))), None)
    if own is not None:
        kind, error = "elsewhere" if isinstance(own, ElsewhereError) else "body", own
    elif isinstance(error, (litellm.AuthenticationError, litellm.PermissionDeniedError)) or status in (401, 403):
        kind = "key"
    elif any(isinstance(cause, RecursionError) for cause in causes):
        kind, error = "body", BodyError("its answer is nested too deeply")
    elif any(isinstance(cause, MemoryError) for cause in causes):
        kind = "memory"
    elif status is not None and 300 <= status < 400:
        kind = "redirect"
    elif isinstance(error, EmptyAnswerError):
        kind = "empty"
    elif isinstance(error, litellm.Timeout):
        kind = "late"
    elif isinstance(error, litellm.BadRequestError):
        kind = "form"
    elif isinstance(error, litellm.APIConnectionError):
        kind = "unreachable"
    else:
        kind = "other"
    headers = getattr(error, "litellm_response_headers", None) or {}
    return {
        "kind": kind,
        "status": status,
        "text": str(error)[:4000] or type(error).__name__,
        "retry_after": str(headers.get("retry-after", ""))[:40],
    }


def _causes(error: BaseException | None) -> Iterable[BaseException]:
    """Yield an error and the errors that caused it."""
    for _ in range(20):
        if error is None:
            return
        yield error
        error = error.__cause__ or error.__context__


def _tried(ask: Callable[[], Any], fallback: Any) -> Any:
    """Return LiteLLM's answer about a model, or the fallback if it does not know the model."""
    try:
        return ask()
    except Exception:  # noqa: BLE001 - of many types
        return fallback


# ---------------------------------------------------------------------- reading from the network


def _bound_transport() -> None:
    """Make httpx, which all providers' clients use, read bodies of limited size and follow no redirect."""
    import httpx  # noqa: PLC0415 - with litellm

    send = httpx.HTTPTransport.handle_request

    def bounded(self: Any, request: Any) -> Any:
        response: Any
        request.headers["accept-encoding"] = "gzip, deflate"  # no other compression is read
        response = send(self, request)
        try:
            content = decoded(whole(response.stream), response.headers.get("content-encoding", ""))
        finally:
            response.close()
        headers = [(name, value) for name, value in response.headers.raw if name.lower() not in _OF_THE_BODY]
        return httpx.Response(response.status_code, headers=headers, content=content, extensions={"http_version": b"HTTP/1.1"})

    httpx.HTTPTransport.handle_request = bounded  # type: ignore[method-assign]
    httpx.Response.has_redirect_location = property(lambda _response: False)  # type: ignore[assignment, method-assign]


def _keep_to(address: str | None) -> None:
    """Refuse requests over HTTP to any other scheme, host and port than those of an address; all if it is empty, none if it is None."""
    import httpx  # noqa: PLC0415 - with litellm

    if address is None:
        return
    stated, send = httpx.URL(address), httpx.HTTPTransport.handle_request

    def kept(self: Any, request: Any) -> Any:
        if not address or any(getattr(request.url, name) != getattr(stated, name) for name in ("scheme", "host", "port")):
            raise ElsewhereError(f"it would ask {request.url.scheme}://{request.url.netloc.decode()}, not the stated address")
        return send(self, request)

    httpx.HTTPTransport.handle_request = kept  # type: ignore[method-assign]


_OF_THE_BODY: Final = frozenset({b"content-encoding", b"content-length", b"transfer-encoding"})


def whole(pieces: Iterable[bytes]) -> bytes:
    """Return a body that comes in pieces.

    Raises:
        BodyError: As soon as it is too long.
    """
    body = bytearray()
    for piece in pieces:
        body += piece
        if len(body) > LARGEST_BODY:
            raise BodyError(_TOO_LARGE)
    return bytes(body)


def decoded(body: bytes, encoding: str) -> bytes:
    """Return a decompressed body.

    Raises:
        BodyError: If it is too long, damaged, or compressed by a method that was not requested.
    """
    names = [name.strip().lower() for name in encoding.split(",")]
    for name in reversed([name for name in names if name not in ("", "identity")]):
        if name not in ("gzip", "x-gzip", "deflate"):
            raise BodyError(f"its answer is compressed by {name[:20]!r}, which was not requested")
        body = _inflated(body)
    return body


def _inflated(body: bytes) -> bytes:
    """Decompress gzip, zlib or raw deflate piece by piece, up to the size that a body may have."""
    raw = len(body) < 2 or (body[:2] != b"\x1f\x8b" and int.from_bytes(body[:2], "big") % 31 != 0)
    reader = zlib.decompressobj(-zlib.MAX_WBITS if raw else _GZIP_OR_ZLIB)
    plain = bytearray()
    try:
        for start in range(0, len(body), _PIECE):
            plain += reader.decompress(body[start : start + _PIECE], LARGEST_BODY + 1 - len(plain))
            if len(plain) > LARGEST_BODY:
                raise BodyError(_TOO_LARGE)
    except zlib.error as error:
        raise BodyError("its answer is compressed and damaged") from error
    if not reader.eof:
        raise BodyError("its answer is compressed and ends too early")
    return bytes(plain)


if __name__ == "__main__":
    main()
