"""The wire: serves over standard input and output, and answers what is no message, so that nobody waits for an answer that never comes."""

from __future__ import annotations

import contextlib
import contextvars
import json
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Any, Final, Self

from mcp.server.mcpserver import MCPServer
from mcp.server.stdio import stdio_server
from mcp.shared._stream_protocols import ReadStream, WriteStream
from mcp.shared.message import SessionMessage
from mcp.types import INVALID_REQUEST, PARSE_ERROR, ErrorData, JSONRPCError
from pydantic import ValidationError

__all__ = ["ArticadServer"]

_WORDS: Final = 200  # characters of a reason


class ArticadServer(MCPServer):  # type: ignore[misc] # the package is not typed
    """A server that answers each line of its input: the library lets those wait for ever that its parser refuses.

    These are texts with half of a surrogate pair, numbers of thousands of digits, and values that are nested too deeply.
    """

    async def run_stdio_async(self) -> None:
        """Serve until the input ends."""
        async with stdio_server() as (heard, said):
            server = self._lowlevel_server
            await server.run(_Answering(heard, said), said, server.create_initialization_options())


class _Answering:
    """What is heard, without what is no message: that is answered at once."""

    def __init__(self, heard: ReadStream[SessionMessage | Exception], said: WriteStream[SessionMessage]) -> None:
        self._heard, self._said = heard, said

    @property
    def last_context(self) -> contextvars.Context | None:
        """The context of who sent the last message."""
        return getattr(self._heard, "last_context", None)

    async def receive(self) -> SessionMessage | Exception:
        """Return the next message."""
        return await self._next(self._heard.receive)

    async def _next(self, read: Callable[[], Awaitable[SessionMessage | Exception]]) -> SessionMessage | Exception:
        while isinstance(item := await read(), Exception):
            if (answer := refusal(item)) is not None:
                await self._said.send(SessionMessage(answer))
        return item

    async def aclose(self) -> None:
        """Hear no more."""
        await self._heard.aclose()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> SessionMessage | Exception:
        return await self._next(self._heard.__anext__)

    async def __aenter__(self) -> Self:
        await self._heard.__aenter__()
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await self._heard.__aexit__(kind, error, trace)


def refusal(error: Exception) -> JSONRPCError | None:
    """Return the answer to a line that is no message, with the number of the request if that can be read; None to an empty line."""
    fault: dict[str, Any] = {"type": "", "msg": str(error)}
    if isinstance(error, ValidationError):
        fault = {**error.errors(include_url=False, include_context=False)[0]}
    if not str(fault.get("input", "?")).strip():
        return None
    is_text = fault["type"] == "json_invalid"
    reason = f"The line is not JSON that is accepted: {fault['msg']}" if is_text else "The line is not a message of JSON-RPC 2.0."
    code = PARSE_ERROR if is_text else INVALID_REQUEST
    return JSONRPCError(jsonrpc="2.0", id=_number(fault.get("input")), error=ErrorData(code=code, message=reason[:_WORDS]))


def _number(line: Any) -> int | str | None:
    """Return the number of the request in a line; None if it cannot be read."""
    found = line
    if isinstance(line, str):
        with contextlib.suppress(ValueError, RecursionError):
            found = json.loads(line, parse_int=_small)
    number = found.get("id") if isinstance(found, dict) else None
    return number if isinstance(number, int | str) and not isinstance(number, bool) and str(number).isprintable() else None


def _small(digits: str) -> int:
    """Return a whole number, or 0 for one that nothing numbers."""
    return int(digits) if len(digits) < 20 else 0
