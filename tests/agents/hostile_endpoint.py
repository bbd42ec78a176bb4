"""An endpoint on this machine that misbehaves on purpose: each way is a function that gets a connected socket after the request."""

from __future__ import annotations

import gzip
import json
import socket
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache
from typing import Any

Misbehaviour = Callable[[socket.socket], None]


@dataclass
class Hostile:
    """What was asked of the endpoint.

    Attributes:
        address: Its own.
        requests: How many HTTP requests came.
        paths: Where to.
    """

    address: str
    paths: list[str] = field(default_factory=list)

    @property
    def requests(self) -> int:
        return len(self.paths)


@contextmanager
def hostile(behave: Misbehaviour) -> Iterator[Hostile]:
    """Serve one misbehaviour until the block ends."""
    listener = socket.create_server(("127.0.0.1", 0), backlog=50)
    told = Hostile(f"http://127.0.0.1:{listener.getsockname()[1]}/v1")

    def answer(line: socket.socket) -> None:
        with line, suppress(OSError):
            path = _read_request(line)
            if path:
                told.paths.append(path)
                behave(line)

    def serve() -> None:
        with suppress(OSError):
            while True:
                line, _ = listener.accept()
                threading.Thread(target=answer, args=(line,), daemon=True).start()

    threading.Thread(target=serve, daemon=True).start()
    try:
        yield told
    finally:
        with suppress(OSError):
            listener.shutdown(socket.SHUT_RDWR)
        listener.close()


def _read_request(line: socket.socket) -> str:
    text = b""
    while b"\r\n\r\n" not in text:
        piece = line.recv(65536)
        if not piece:
            return ""
        text += piece
    head, _, body = text.partition(b"\r\n\r\n")
    length = next((int(row.split(b":")[1]) for row in head.split(b"\r\n") if row.lower().startswith(b"content-length")), 0)
    while len(body) < length:
        body += line.recv(65536)
    return head.split(b" ")[1].decode()


# ---------------------------------------------------------------------- the ways


def _head(status: str = "200 OK", *lines: str, length: int | None = None) -> bytes:
    rows = [f"HTTP/1.1 {status}", "content-type: application/json", "connection: close", *lines]
    return "\r\n".join([*rows, *([] if length is None else [f"content-length: {length}"]), "", ""]).encode()


def completion(content: Any) -> bytes:
    """Return a completion whose message has this content."""
    message = {"index": 0, "finish_reason": "stop", "message": {"role": "assistant", "content": content}}
    return json.dumps({"id": "1", "object": "chat.completion", "created": 0, "model": "m", "choices": [message]}).encode()


def says(body: bytes, status: str = "200 OK", *lines: str) -> Misbehaviour:
    """Return what answers with a body."""
    return lambda line: line.sendall(_head(status, *lines, length=len(body)) + body)


def hang(line: socket.socket) -> None:
    time.sleep(60)


def hang_after_the_head(line: socket.socket) -> None:
    line.sendall(_head(length=1000))
    time.sleep(60)


def drip(line: socket.socket) -> None:
    line.sendall(_head(length=100_000))
    for _ in range(600):
        line.sendall(b" ")
        time.sleep(0.1)


def drip_the_head(line: socket.socket) -> None:
    line.sendall(b"HTTP/1.1 200 OK\r\n")
    for number in range(600):
        line.sendall(f"x-{number}: 1\r\n".encode())
        time.sleep(0.1)


def endless_head(line: socket.socket) -> None:
    line.sendall(b"HTTP/1.1 200 OK\r\n")
    while True:
        line.sendall(b"x: " + b"y" * 60_000 + b"\r\n")


def endless_continue(line: socket.socket) -> None:
    while True:
        line.sendall(b"HTTP/1.1 100 Continue\r\n\r\n" * 100)


def endless_body(line: socket.socket) -> None:
    line.sendall(_head())
    while True:
        line.sendall(b" " * 2**20)


def a_gibibyte(line: socket.socket) -> None:
    line.sendall(_head(length=2**30))
    for _ in range(2**10):
        line.sendall(b"x" * 2**20)


def endless_chunks(line: socket.socket) -> None:
    line.sendall(_head("200 OK", "transfer-encoding: chunked"))
    while True:
        line.sendall(b"1\r\nx\r\n" * 10_000)


@cache
def bomb() -> bytes:
    """Return half a gibibyte of zeros, by gzip."""
    packer = zlib.compressobj(1, zlib.DEFLATED, 31)
    return b"".join(packer.compress(bytes(2**20)) for _ in range(512)) + packer.flush()


def gzip_bomb(line: socket.socket) -> None:
    says(bomb(), "200 OK", "content-encoding: gzip")(line)


def gzip_in_gzip(line: socket.socket) -> None:
    says(gzip.compress(bomb()), "200 OK", "content-encoding: gzip, gzip")(line)


def foreign_compression(line: socket.socket) -> None:
    says(b"\x1b" + bytes(5000), "200 OK", "content-encoding: br")(line)


def spoiled_gzip(line: socket.socket) -> None:
    says(gzip.compress(completion("x"))[:-9], "200 OK", "content-encoding: gzip")(line)


def many_small_objects(line: socket.socket) -> None:
    says(b'{"choices": [' + b"{}," * 2_500_000 + b"{}]}")(line)


def half_closed(line: socket.socket) -> None:
    line.sendall(_head(length=1000) + b'{"choices"')
    line.shutdown(socket.SHUT_WR)
    time.sleep(60)


def reset(line: socket.socket) -> None:
    line.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\x01\0\0\0\0\0\0\0")


def no_http(line: socket.socket) -> None:
    line.sendall(b"\x16\x03\x01" + bytes(500))


def patient(line: socket.socket) -> None:
    says(b"{}", "429 Too Many Requests", "retry-after: 100000")(line)


def busy_for_ever(line: socket.socket) -> None:
    says(b"{}", "503 Service Unavailable", "retry-after: 0")(line)


def redirects_to(address: str, status: str = "307 Temporary Redirect") -> Misbehaviour:
    """Return what sends everybody to another address."""
    return says(b"", status, f"location: {address}")
