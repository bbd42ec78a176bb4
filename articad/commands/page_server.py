"""An HTTP server for this machine's browser that bounds what others can take from it: connections, time, and the size of a request."""

from __future__ import annotations

import contextlib
import socket
import sys
import threading
import time
from http.client import HTTPException, LineTooLong
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, BinaryIO, Final, cast

CONNECTIONS: Final = 32
"""At one time; for one more, the one is closed that has asked for the longest time without an end."""
ASKING_S: Final = 5.0
"""Until a request has arrived whole."""
ANSWERING_S: Final = 60.0
"""Until its answer has left: a page has some megabytes, and a forwarded port is slow."""
HEAD_BYTES: Final = 65_536
"""Of a request: browsers send the cookies of every other server of this machine, too."""
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
}
"""Of every answer: no other site shows it in a frame or loads it as its own, and nobody keeps it."""


class BoundedServer(ThreadingHTTPServer):
    """Serves each connection in a thread, on 127.0.0.1, within the bounds of this module.

    Args:
        port: 0 for any that is free.
        handler: Answers the requests.
    """

    daemon_threads = True
    request_queue_size = 128  # connections that the kernel keeps until they are accepted

    def __init__(self, port: int, handler: type[BoundedHandler]) -> None:
        self._open: dict[socket.socket, tuple[bool, float]] = {}  # whether it is being answered, and when it is closed
        self._guard = threading.Lock()
        super().__init__(("127.0.0.1", port), handler)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serve a new connection in a thread; close another one if there are too many."""
        with self._guard:
            if len(self._open) >= CONNECTIONS:
                self._hang_up(min(self._open, key=lambda known: self._open[known]))
            self._open[request] = (False, time.monotonic() + ASKING_S)
        super().process_request(request, client_address)

    def answer_begins(self, request: socket.socket) -> None:
        """Give a connection whose request is complete the time for an answer."""
        with self._guard:
            if request in self._open:
                self._open[request] = (True, time.monotonic() + ANSWERING_S)

    def service_actions(self) -> None:
        """Close connections whose time is over; called twice a second, and after each new one."""
        now = time.monotonic()
        with self._guard:
            for request in [request for request, (_, until) in self._open.items() if until < now]:
                self._hang_up(request)

    def close_request(self, request: Any) -> None:
        """Forget a connection that has ended."""
        with self._guard:
            self._open.pop(request, None)
        super().close_request(request)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of connections that were closed, here or there."""
        if not isinstance(sys.exc_info()[1], OSError | HTTPException):
            super().handle_error(request, client_address)

    def _hang_up(self, request: socket.socket) -> None:
        """End both directions of a connection, so that the thread that serves it ends."""
        del self._open[request]
        with contextlib.suppress(OSError):
            request.shutdown(socket.SHUT_RDWR)


class BoundedHandler(BaseHTTPRequestHandler):
    """Reads the head of a request within bounds, and adds the headers that every answer has."""

    def setup(self) -> None:
        """Bound the head."""
        super().setup()
        self.rfile = cast("BinaryIO", _Head(self.rfile))  # type: ignore[assignment]

    def end_headers(self) -> None:
        """Add the headers that every answer has."""
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def version_string(self) -> str:
        """Tell no version of Python."""
        return "articad"

    def log_message(self, *_: object) -> None:
        """Log nothing."""


class _Head:
    """The lines of a request's head, up to a number of bytes in all."""

    def __init__(self, stream: Any) -> None:
        self._stream, self._left = stream, HEAD_BYTES

    def readline(self, size: int) -> bytes:
        """Return the next line.

        Raises:
            LineTooLong: If the head is too long.
        """
        line: bytes = self._stream.readline(min(size, self._left + 1))
        self._left -= len(line)
        if self._left < 0:
            raise LineTooLong("head")
        return line

    def close(self) -> None:
        """Close the stream."""
        self._stream.close()
