"""Of the environment, calls of models obey the variables of proxies and certificates that SECURITY.md names, and no others."""

from __future__ import annotations

import datetime as dt
import ipaddress
import os
import re
import ssl
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec

from articad.agents.live import LiteLLM
from articad.agents.llm import Request, user
from articad.errors import TransportError
from tests.agents.openai_stub import completion, respond

PROXIES = ("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY", "NO_PROXY")
CERTIFICATES = ("SSL_CERT_FILE", "SSL_CERT_DIR", "SSL_VERIFY", "SSL_CERTIFICATE", "REQUESTS_CA_BUNDLE", "CURL_CA_BUNDLE")
QUESTION = Request(step="x", role="designer", messages=(user("hi"),))
SECURITY = Path(__file__).parents[2] / "SECURITY.md"


class Handler(BaseHTTPRequestHandler):
    """Answers as a model does, and lists what it is asked for."""

    asked: list[str]

    def do_POST(self) -> None:
        self.asked.append(self.path)
        self.rfile.read(int(self.headers["content-length"]))
        respond(self, 200, completion("hello"), {})

    def do_CONNECT(self) -> None:
        self.asked.append(f"CONNECT {self.path}")
        self.send_error(403)

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base class's name
        pass


@contextmanager
def served(certificate: Path | None = None) -> Iterator[tuple[str, list[str]]]:
    """Serve on this machine, as a proxy too; yield the host with its port, and what is asked for."""
    asked: list[str] = []
    with ThreadingHTTPServer(("127.0.0.1", 0), type("Listing", (Handler,), {"asked": asked})) as server:
        if certificate is not None:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(certificate)
            server.socket = context.wrap_socket(server.socket, server_side=True)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"127.0.0.1:{server.server_address[1]}", asked
        server.shutdown()


@pytest.fixture(autouse=True)
def stated(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """An environment in which nothing is stated but a key."""
    for name in (*PROXIES, *CERTIFICATES):
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.lower(), raising=False)
    monkeypatch.setenv("OPENAI_API_KEY", "sk-none")
    return monkeypatch


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A key and a certificate of this machine that nobody else vouches for, in one file."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "127.0.0.1")])
    today = dt.datetime.now(dt.UTC)
    builder = x509.CertificateBuilder(name, name, key.public_key(), x509.random_serial_number(), today, today + dt.timedelta(days=2))
    address = x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))])
    made = builder.add_extension(address, critical=False).sign(key, hashes.SHA256())
    form = (serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    path = tmp_path_factory.mktemp("tls") / "both.pem"
    path.write_bytes(key.private_bytes(*form) + made.public_bytes(serialization.Encoding.PEM))
    return path


def answered(base: str) -> bool:
    """Return whether a model at an address answers."""
    try:
        return LiteLLM("stub", api_base=base, tries=1).complete(QUESTION).text == "hello"
    except TransportError:
        return False


@pytest.mark.parametrize(
    ("variables", "base", "asked"),
    [
        (("HTTP_PROXY",), "http://models.invalid/v1", ["http://models.invalid/v1/chat/completions"]),
        (("ALL_PROXY",), "http://models.invalid/v1", ["http://models.invalid/v1/chat/completions"]),
        (("HTTPS_PROXY",), "http://models.invalid/v1", []),
        (("HTTPS_PROXY",), "https://models.invalid/v1", ["CONNECT models.invalid:443"]),
        (("ALL_PROXY",), "https://models.invalid/v1", ["CONNECT models.invalid:443"]),
        (("HTTP_PROXY", "NO_PROXY"), "http://models.invalid/v1", []),
        ((), "http://models.invalid/v1", []),
    ],
)
def test_a_proxy_is_asked_only_if_it_is_stated(variables: tuple[str, ...], base: str, asked: list[str], stated: pytest.MonkeyPatch) -> None:
    with served() as (proxy, seen):
        for name in variables:
            stated.setenv(name, "models.invalid" if name == "NO_PROXY" else f"http://{proxy}")
        assert answered(base) == (asked[:1] == ["http://models.invalid/v1/chat/completions"])
        assert seen == asked


@pytest.mark.parametrize(
    ("variables", "trusts"),
    [
        ({}, False),
        ({"SSL_CERT_FILE": "FILE"}, True),
        ({"SSL_VERIFY": "False"}, True),
        ({"SSL_VERIFY": "True"}, False),
        ({"REQUESTS_CA_BUNDLE": "FILE"}, False),
        ({"CURL_CA_BUNDLE": "FILE"}, False),
    ],
)
def test_an_unknown_certificate_is_trusted_only_if_the_environment_says_so(
    variables: Mapping[str, str], trusts: bool, certificate: Path, stated: pytest.MonkeyPatch
) -> None:
    for name, value in variables.items():
        stated.setenv(name, str(certificate) if value == "FILE" else value)
    with served(certificate) as (host, seen):
        assert answered(f"https://{host}/v1") is trusts
        assert bool(seen) is trusts  # without trust not even the prompt is sent


def test_the_page_names_the_variables() -> None:
    told = set(re.findall(r"`([A-Z_]+)`", SECURITY.read_text()))
    assert {*PROXIES, *CERTIFICATES} <= told


PROVIDERS = {
    "openai/gpt-4o": "OPENAI",
    "anthropic/claude-3-5-sonnet-20241022": "ANTHROPIC",
    "gemini/gemini-1.5-pro": "GEMINI",
    "mistral/mistral-large-latest": "MISTRAL",
    "groq/llama-3.3-70b-versatile": "GROQ",
    "deepseek/deepseek-chat": "DEEPSEEK",
    "openrouter/openai/gpt-4o": "OPENROUTER",
    "xai/grok-2": "XAI",
    "cohere_chat/command-r": "COHERE",
    "together_ai/meta-llama/Llama-3-8b": "TOGETHERAI",
    "ollama_chat/llama3": "OLLAMA",
    "litellm_proxy/m": "LITELLM_PROXY",
}
LOUD = {
    "LITELLM_LOCAL_MODEL_COST_MAP": "False",
    "LITELLM_LOCAL_ANTHROPIC_BETA_HEADERS": "False",
    "LITELLM_LOG": "DEBUG",
    "LITELLM_MODE": "DEV",
    "LITELLM_DISABLE_REDACT_SECRETS": "True",
    "LITELLM_LENS_URL": "https://lens.invalid",
}


@pytest.mark.parametrize("more", [{}, LOUD], ids=["quiet", "loud"])
@pytest.mark.parametrize("model", PROVIDERS)
def test_no_host_is_asked_but_the_one_that_is_stated(model: str, more: Mapping[str, str], stated: pytest.MonkeyPatch) -> None:
    """Whatever LiteLLM looks up about a provider comes from its own files: a proxy sees every other host that is asked."""
    for name, value in {f"{PROVIDERS[model]}_API_KEY": "sk-none", **more}.items():
        stated.setenv(name, value)
    with served() as (host, asked), served() as (proxy, elsewhere):
        stated.setenv("HTTPS_PROXY", f"http://{proxy}")
        with suppress(TransportError):  # not every provider's answers have the form of these
            LiteLLM(model, api_base=f"http://{host}/v1", tries=1).complete(QUESTION)
        assert elsewhere == []
        assert asked


def test_no_list_of_models_or_headers_is_fetched() -> None:
    """LiteLLM fetches its newest lists unless it is told not to: the one of headers at the first call of Bedrock, long after the import."""
    code = """
import os, sys
from articad.agents import provider
litellm = provider.load()
provider._become_environment(dict(os.environ) | eval(sys.argv[1]))
import httpx
fetched = []
httpx.get = lambda *words, **_: fetched.append(words) or 1 / 0
from litellm import anthropic_beta_headers_manager
from litellm.litellm_core_utils import get_model_cost_map
assert anthropic_beta_headers_manager._load_beta_headers_config()
assert get_model_cost_map.get_model_cost_map("https://elsewhere.invalid")
print(fetched)
"""
    done = subprocess.run([sys.executable, "-c", code, repr(LOUD)], env=os.environ | LOUD, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "[]", done.stderr


@pytest.mark.slow
def test_no_provider_asks_another_host_than_the_stated_one() -> None:
    """All that LiteLLM knows, with models that it does not know: it would look some up at the ports of Ollama and Lemonade, with the key."""
    code = """
import json, os, socket
from articad.agents import provider
litellm = provider.load()
import httpx
OWN = "127.0.0.9"
elsewhere = set()

def spied(real, host_of):
    def call(*words, **more):
        host = host_of(*words)
        if host not in (None, OWN):
            elsewhere.add(f"{doing} {host}")
            raise socket.gaierror("nobody is reached in this test")
        return real(*words, **more)
    return call

socket.getaddrinfo = spied(socket.getaddrinfo, lambda host, *_: host)
socket.socket.connect = spied(socket.socket.connect, lambda _, address: address[0] if isinstance(address, tuple) else None)
bounded = httpx.HTTPTransport.handle_request
names = [getattr(name, "value", name) for name in litellm.provider_list]
assert len(names) > 100
os.environ |= {"AWS_ACCESS_KEY_ID": "none", "AWS_SECRET_ACCESS_KEY": "none"}  # else it looks for a machine's own, which is a login
os.environ |= {f"{name.upper()}_API_KEY": "sk-none" for name in names}
for model in (f"{name}/{rest}" for name in names for rest in ("some-model", "meta/llama-3-8b")):
    words = {"model": model, "messages": [{"role": "user", "content": "why?"}], "api_base": f"http://{OWN}:9/v1"}
    for order in ({"do": "describe", "models": [model]}, {"do": "complete", "seconds": 5, "is_local": True, "arguments": words}):
        doing = f"{order['do']} {model}"
        httpx.HTTPTransport.handle_request = bounded  # as in the process of each call
        provider._answer(litellm, order)
print(json.dumps(sorted(elsewhere)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.strip().splitlines()[-1:] == ["[]"], done.stdout + done.stderr[-3000:]
