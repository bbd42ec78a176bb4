"""Nothing of the package, and nothing that it imports, asks the network or sends anything, until a model is asked."""

from __future__ import annotations

import json
import os
import subprocess
import sys

# Sockets are refused before anything else is imported; each module of the package is listed with what it tried.
PROGRAM = """
import json, pkgutil, socket, sys
tried = []
def refuse(what):
    def call(*arguments, **named):
        if what == "bind" and arguments[1][0] in ("::1", "127.0.0.1"):
            return None  # urllib3 asks so whether there is IPv6; nothing leaves the machine
        tried.append([what, repr(arguments)[:200]])
        raise OSError("no network in this test")
    return call
for name in ("connect", "connect_ex", "sendto", "bind"):
    setattr(socket.socket, name, refuse(name))
for name in ("create_connection", "getaddrinfo", "gethostbyname"):
    setattr(socket, name, refuse(name))
import articad, importlib
failed = {}
names = [module.name for module in pkgutil.walk_packages(articad.__path__, "articad.")]
for name in names if len(sys.argv) == 1 else ():
    if ".inside_freecad" in name or name.endswith("__main__") or ".examples." in name or ".starter" in name or ".snippets" in name:
        continue
    try:
        importlib.import_module(name)
    except ImportError as error:
        if getattr(error, "name", "").partition(".")[0] == "articad":
            failed[name] = str(error)
if len(sys.argv) > 1:
    exec(sys.argv[1])
print(json.dumps({"tried": tried, "failed": failed, "count": len(names)}))
"""


def told(extra: str = "", **environment: str) -> dict[str, object]:
    quiet = {name: value for name, value in os.environ.items() if not name.startswith("LITELLM")}
    command = [sys.executable, "-W", "ignore", "-c", PROGRAM, *([extra] if extra else [])]
    done = subprocess.run(command, env=quiet | environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    answer: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return answer


def test_importing_every_module_asks_no_network() -> None:
    answer = told()

    assert answer["tried"] == []
    assert answer["failed"] == {}
    assert isinstance(answer["count"], int)
    assert answer["count"] > 100


def test_making_a_model_asks_no_network_and_turns_telemetry_off() -> None:
    program = (
        "from articad.agents import provider\n"
        "from articad.agents.live import LiteLLM\n"
        "assert provider._describe(provider.load(), {'models': ['openai/gpt-5.2']})['models']['openai/gpt-5.2']['has_key']\n"
        "LiteLLM('openai/gpt-5.2')\n"
        "import litellm, os\n"
        "assert litellm.telemetry is False\n"
        "assert not litellm.success_callback and not litellm.failure_callback and not litellm.callbacks\n"
        "assert os.environ['LITELLM_LOCAL_MODEL_COST_MAP'] == 'True'\n"
    )

    others = {"LANGFUSE_PUBLIC_KEY": "x", "OTEL_EXPORTER_OTLP_ENDPOINT": "http://127.0.0.1:9"}  # of programs that litellm reports to
    assert told(program, OPENAI_API_KEY="not-a-key", **others)["tried"] == []
