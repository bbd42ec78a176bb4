"""A stranger's folder is the working folder, the folder of temporary files and the home: no command and no tool runs what is in it."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from mcp import Client, StdioServerParameters
from mcp.client.stdio import stdio_client

from articad.commands.command import COMMANDS
from articad.errors import KernelUnavailableError
from articad.kernels import freecad_install
from tests.agents.openai_stub import Canned, openai_stub
from tests.coroutines import finish
from tests.planting import planted

# As the console script starts: without the working folder on the path.
ARTICAD = [sys.executable, "-P", "-c", "import sys; from articad.cli import main; sys.exit(main())"]

LINES = """
new product
new lamp --example desk_lamp
check product
part product tray
build product --out complete --complete
build product --out run --verify sampled --export urdf,mjcf
check run --motion --joints --support
certify run --budget 1
certify run --budget 1 --within-tolerance --tolerance-class m
verify-certificate run/certificate.json
export run --to urdf,mjcf,step
bom run --cuts --to csv,xlsx
order run --fasten hinge=purchased
manual run --to pdf,svg,html
drawing run --to svg,pdf,dxf
audit run/export/urdf/product.urdf --fix mended.urdf --collision pieces --report audit.html
audit run/export/mjcf/product.xml --certify 1
audit run/export --table
sim run/export/urdf/product.urdf --film film.png
convert run/export/urdf/product.urdf other.xml
convert foreign.xml foreign.urdf
convert run/export/step/product.step step/part.urdf
export run --to freecad --split --trees --drawings
export run --to usd,sdf,glb,3mf,plan
export run --to urdf --ros robot
pull run run/export/freecad/product.FCStd --out pulled
install freecad --remove
adopt run/export/mjcf/product.xml --out adopted --no-audit
render run --size 64 --out pictures --section x --overlaps
render run --size 64 --out clean --clean --transparent
render run --size 64 --out film --motion hinge
render run --size 64 --out viewed --renderer pyvista
show run --no-browser --out page.html
edit run --set width=50 --out edited --no-pictures
replay RECORDED --out again
batch batch.json --out made --jobs 1
bench list --sentences
bench draw --task arch_stone_seven --out drawn
bench score nothing --task arch_stone_seven
bench table nothing
bench shapes nothing --data nowhere
bench objects nothing --data nowhere
memory seed
memory list
memory search box
memory export cases.jsonl
memory import cases.jsonl
memory prune
memory show nothing
memory remove nothing
completion bash
skill print
skill install
doctor
"""
RECORDED = Path(__file__).parent / "recordings" / "toy"
LACKING = ("E_KERNEL_UNAVAILABLE kernels.freecad", "PyVista cannot draw here", "E_READ")
"""What commands say where FreeCAD, the optional renderer, or the file or case that a line names is missing."""
WITH_A_MODEL = ("generate", "resume")
SERVERS = ("watch", "mcp")


@pytest.fixture
def stranger(tmp_path: Path) -> Path:
    folder = tmp_path / "stranger"
    folder.mkdir()
    planted(folder)
    (folder / ".env").write_text("OPENAI_BASE_URL=http://127.0.0.1:9/v1\n")
    (folder / "foreign.xml").write_text(
        '<mujoco><worldbody><geom size="1"/><body pos="9 0 0"><joint/><geom size="1"/></body></worldbody></mujoco>'
    )
    (folder / "batch.json").write_text(json.dumps({"items": [{"plan": "product", "formats": ["urdf"]}]}))
    return folder


def variables(folder: Path, temporary: Path | None = None) -> dict[str, str]:
    """Return an environment whose home, and temporary files unless they have a folder of their own, are in a folder."""
    kept = {name: os.environ[name] for name in ("PATH", "LANG", "ARTICAD_SANDBOX") if name in os.environ}
    with suppress(KernelUnavailableError):
        kept["ARTICAD_FREECAD"] = str(freecad_install.find().root)  # it would not be found in the stranger's home
    return kept | {"HOME": str(folder), "TMPDIR": str(temporary or folder), "OPENAI_API_KEY": "key", "OPENBLAS_NUM_THREADS": "1"}


def marks(folder: Path) -> str:
    mark = folder.parent / f"{folder.name}.mark"
    return mark.read_text() if mark.exists() else ""


ELSEWHERE = {
    "bench run": "generate",
    "bench judge": "generate",
    "bench faults": "build, check and edit",
    "bench cheats": "bench score",
    "bench make": "build",
}
"""Actions that run what other lines run, and take minutes or a model."""
HARMLESS = """
--root --budget --no-engines --density --sandbox --out --jobs --memory --kernel --set --force --api-base --docs --look --no-look --strict
--no-inspection --max-calls --max-tokens --max-cost --max-minutes --rounds --repairs --variant --model --vision-model --judge-model
--embeddings --keep --tasks --some --kind --at-once --judge --refine --recorded --size --sheet --kerf --turn --purchased --epsilon
--joints --pairs --no-pairs --script --fuse --no-build --srdf --keep-frames --flat --image --part-image --review --ideas --pick --loops --collision
--actuators --process --case --repair --next --port --dir --formats --export --views --parts --explode --engine --scheduler --seconds --meshes --seed
"""
"""Options that choose numbers, names, places or one of the ways that are tried without them; they start no code of their own."""


def test_each_command_and_what_it_can_be_asked_for_has_a_line() -> None:
    """A new command, action or option fails here until a line runs it, or somebody states why it runs nothing new."""
    words = [line.split() for line in LINES.split("\n") if line]
    assert {line[0] for line in words} | {*WITH_A_MODEL, *SERVERS} == set(COMMANDS)
    for name, command in COMMANDS.items():
        parser = argparse.ArgumentParser()
        command.arguments(parser)
        run = {word for line in words if line[0] == name for word in line}
        asked = {f"{name} {choice}" for action in parser._actions if action.dest == "action" for choice in action.choices or ()}
        assert {choice for choice in asked if choice.split()[1] not in run} <= set(ELSEWHERE)
        flags = {flag for action in parser._actions for flag in action.option_strings if flag.startswith("--")} - {"--help"}
        tried = {word for line in words for word in line}  # by whichever command: the same option means the same
        assert flags - set(HARMLESS.split()) <= tried, name


@pytest.mark.slow
def test_no_command_runs_what_a_stranger_planted(stranger: Path) -> None:
    for line in LINES.strip().replace("RECORDED", str(RECORDED)).split("\n"):
        done = subprocess.run(
            [*ARTICAD, *line.split()], cwd=stranger, env=variables(stranger), capture_output=True, text=True, check=False, timeout=500
        )
        assert marks(stranger) == "", line
        lacks = done.returncode == 3 and any(words in done.stderr for words in LACKING)
        assert done.returncode in {0, 1} or lacks, (line, done.stdout, done.stderr)


@pytest.mark.slow
def test_neither_models_nor_the_page_server_run_what_a_stranger_planted(stranger: Path) -> None:
    with openai_stub([Canned(status=400, body=b"{}")]) as stub:
        words = ["generate", "a box", "--model", "openai/gpt-x", "--api-base", stub.address, "--out", "run", "--no-pictures"]
        subprocess.run([*ARTICAD, *words], cwd=stranger, env=variables(stranger), capture_output=True, check=False, timeout=300)
        assert stub.received
        words = ["resume", "run", "--api-base", stub.address]
        subprocess.run([*ARTICAD, *words], cwd=stranger, env=variables(stranger), capture_output=True, check=False, timeout=300)
    subprocess.run([*ARTICAD, "new", "product"], cwd=stranger, env=variables(stranger), check=True, timeout=300)
    words = ["watch", "product", "--no-browser"]
    with subprocess.Popen([*ARTICAD, *words], cwd=stranger, env=variables(stranger), stdout=subprocess.DEVNULL) as watching:
        until = time.monotonic() + 120
        while time.monotonic() < until and not list(stranger.glob(".cache/articad/parts/*")):
            time.sleep(0.5)
        watching.terminate()
    assert marks(stranger) == ""


@pytest.mark.slow
def test_no_tool_runs_what_a_stranger_planted_in_the_root_or_among_temporary_files(stranger: Path) -> None:
    """Temporary files are outside the root, as usual: no tool takes its own for files that lead out of the root."""
    temporary = stranger.with_name("temporary")
    planted(temporary)
    subprocess.run([*ARTICAD, "new", "product"], cwd=stranger, env=variables(stranger), check=True, timeout=300)
    calls: dict[str, dict[str, Any]] = {
        "schema": {"topic": "plan"},
        "check_plan": {"design": "product"},
        "build_part": {"design": "product", "part": "tray"},
        "build_parts": {"design": "product"},
        "edit_plan": {"design": "product", "changes": {"parameters.width": 52.0}},
        "build": {"design": "product"},
        "check": {"design": "product"},
        "certify": {"design": "product", "budget_s": 1.0},
        "verify_certificate": {"design": "product"},
        "audit": {"design": "product"},
        "sim": {"design": "product"},
        "render": {"design": "product"},
        "export": {"design": "product", "formats": ["urdf", "mjcf"]},
        "manual": {"design": "product"},
        "convert": {"source": "product/run/export/urdf/product.urdf", "target": "other.xml"},
        "adopt": {"source": "product/run/export/urdf/product.urdf", "design": "adopted"},
        "edit_parameters": {"design": "product", "values": {"width": 50.0}},
        "explain": {"code": "E_DUP_NAME"},
        "docs": {"dialect": "build123d", "intent": "fillet"},
    }

    async def session() -> None:
        server = StdioServerParameters(
            command=ARTICAD[0], args=[*ARTICAD[1:], "mcp", "--root", str(stranger)], env=variables(stranger, temporary), cwd=stranger
        )
        async with Client(stdio_client(server)) as client:
            assert {tool.name for tool in (await client.list_tools()).tools} == set(calls)
            for name, arguments in calls.items():
                answer = await client.call_tool(name, arguments)
                assert marks(stranger) == marks(temporary) == "", name
                assert not answer.is_error, (name, answer.content)
            assert (await client.read_resource("ui://articad/designs/product")).contents
            assert marks(stranger) == marks(temporary) == ""

    finish(session())
