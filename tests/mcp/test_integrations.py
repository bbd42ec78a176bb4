"""The entries for hosts start a server that exists, and the plugin holds the skill that the package prints."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from articad import __version__
from articad.commands.command import COMMANDS
from articad.mcp.skill import skill

ROOT = Path(__file__).parents[2]
HOSTS = ROOT / "integrations"


def entries() -> dict[str, dict[str, Any]]:
    """Return how each host starts the server."""
    plugin = json.loads((HOSTS / "claude-code" / ".claude-plugin" / "plugin.json").read_text())
    cursor = json.loads((HOSTS / "cursor" / "mcp.json").read_text())
    codex = tomllib.loads((HOSTS / "codex" / "config.toml").read_text())
    return {
        "claude code": plugin["mcpServers"]["articad"],
        "cursor": cursor["mcpServers"]["articad"],
        "codex": codex["mcp_servers"]["articad"],
    }


@pytest.mark.parametrize("host", ["claude code", "cursor", "codex"])
def test_a_host_starts_the_server_of_this_package(host: str) -> None:
    entry = entries()[host]
    assert entry["command"] == "articad"
    command, *words = entry["args"]
    assert command in COMMANDS
    assert words == ["--root", "designs"]


def test_the_plugin_holds_the_skill_and_the_version_of_the_package() -> None:
    plugin = HOSTS / "claude-code"
    assert (plugin / "skills" / "articad" / "SKILL.md").read_text() == skill()
    assert json.loads((plugin / ".claude-plugin" / "plugin.json").read_text())["version"] == __version__
    (listed,) = json.loads((ROOT / ".claude-plugin" / "marketplace.json").read_text())["plugins"]
    assert (ROOT / listed["source"]).resolve() == plugin
