"""The page server among connections that send nothing, too slowly or too much, and sites that want to show its page."""

from __future__ import annotations

import http.client
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from articad.commands.watching import PageServer

PATIENCE_S = 20.0  # on a busy machine


@pytest.fixture
def server() -> Iterator[PageServer]:
    with PageServer() as served:
        served.page = "<!doctype html><title>shown</title>"
        yield served


def connected(server: PageServer, *, to_send: bytes = b"") -> socket.socket:
    made = socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE_S)
    made.sendall(to_send)
    return made


def answered(server: PageServer, path: str = "/", host: str | None = None) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE_S)
    connection.request("GET", path, headers={"Host": host or f"127.0.0.1:{server.port}"})
    return connection.getresponse()


def ended(connection: socket.socket) -> bool:
    """Return whether the server closes a connection within the time of its socket."""
    try:
        while connection.recv(4096):
            pass
    except ConnectionError:
        return True
    except TimeoutError:
        return False
    return True


@pytest.mark.parametrize("to_send", [b"", b"GET", b"GET / HTTP/1.1\r\nHost: a\r\n"])
def test_connections_that_ask_nothing_use_few_threads_and_keep_nobody_out(to_send: bytes, server: PageServer) -> None:
    before = threading.active_count()
    with ExitStack() as stack:
        idle = [stack.enter_context(connected(server, to_send=to_send)) for _ in range(200)]
        started = time.monotonic()
        assert b"shown" in answered(server).read()
        assert time.monotonic() - started < 5.0
        until = time.monotonic() + PATIENCE_S
        while threading.active_count() > before + 40 and time.monotonic() < until:
            time.sleep(0.05)
        assert threading.active_count() <= before + 40
        assert all(ended(connection) for connection in idle)
        assert time.monotonic() - started < PATIENCE_S
        assert b"shown" in answered(server).read()


def test_a_request_that_drips_is_closed_though_each_of_its_bytes_comes_soon(server: PageServer) -> None:
    with connected(server, to_send=b"GET / HTTP/1.1\r\nX: ") as dripping:
        started = time.monotonic()
        closed = False
        while not closed and time.monotonic() - started < PATIENCE_S:
            try:
                dripping.sendall(b"x")
                time.sleep(0.2)
            except ConnectionError:
                closed = True
        assert closed


def test_who_does_not_read_the_answer_keeps_nobody_out(server: PageServer) -> None:
    server.page = "x" * 20_000_000
    request = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode()
    with ExitStack() as stack:
        for _ in range(60):
            stack.enter_context(connected(server, to_send=request))
        assert answered(server, "/version").status == 200


@pytest.mark.parametrize(
    "head",
    [b"GET /" + b"a" * 10_000_000, b"GET / HTTP/1.1\r\n" + b"X: a\r\n" * 1_000_000, b"GET / HTTP/1.1\r\nX: " + b"a" * 10_000_000],
)
def test_a_head_without_end_is_refused(head: bytes, server: PageServer) -> None:
    with connected(server) as connection:
        try:
            connection.sendall(head)
        except ConnectionError:
            return
        assert ended(connection)
    assert b"shown" in answered(server).read()


@pytest.mark.parametrize(
    ("path", "host", "status"), [("/", None, 200), ("/version", None, 200), ("/x", None, 404), ("/", "evil.example", 403)]
)
def test_no_other_site_can_show_frame_or_keep_an_answer(path: str, host: str | None, status: int, server: PageServer) -> None:
    answer = answered(server, path, host)
    assert answer.status == status
    headers = {name.lower(): value for name, value in answer.getheaders()}
    assert headers["x-frame-options"] == "DENY"
    assert headers["content-security-policy"] == "frame-ancestors 'none'"
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["cache-control"] == "no-store"
    assert headers["cross-origin-resource-policy"] == "same-origin"
    assert "Python" not in headers["server"]
    assert b"shown" not in answer.read() or status == 200


def test_connections_that_end_early_print_nothing(server: PageServer, capfd: pytest.CaptureFixture[str]) -> None:
    server.page = "x" * 20_000_000
    for _ in range(5):
        connected(server, to_send=f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n\r\n".encode()).close()
    assert answered(server, "/version").status == 200
    time.sleep(0.5)
    assert capfd.readouterr() == ("", "")
