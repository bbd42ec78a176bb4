"""The entries for hosts start a server that exists, and the plugin holds the skill that the package prints."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from articad import __version__
from articad.commands.command import COMMANDS
from articad.mcp.server import Tools
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


FIELDS = {
    # https://code.claude.com/docs/en/plugins/manifest-reference
    "plugin": {"name", "version", "description", "author", "homepage", "repository", "license", "keywords", "mcpServers", "skills"},
    "claude code": {"type", "command", "args", "env", "cwd"},
    # https://code.claude.com/docs/en/plugins/marketplace-reference
    "marketplace": {"name", "owner", "plugins", "description", "version", "metadata"},
    "listed": {"name", "source", "description", "version", "author", "homepage", "repository", "license", "keywords", "category", "tags"},
    # https://developers.openai.com/codex/mcp
    "codex": {"command", "args", "env", "env_vars", "cwd", "startup_timeout_sec", "tool_timeout_sec", "enabled", "required"},
    # https://cursor.com/docs/mcp
    "cursor": {"type", "command", "args", "env", "envFile"},
}
"""The fields that the documentation of each host has for a local server, for a plugin of Claude Code and for its list of plugins."""
KEBAB = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")


@pytest.mark.parametrize("host", ["claude code", "cursor", "codex"])
def test_an_entry_has_only_fields_of_its_host_each_of_its_type(host: str) -> None:
    entry = entries()[host]
    assert set(entry) <= FIELDS[host]
    assert isinstance(entry["command"], str)
    assert all(isinstance(word, str) for word in entry["args"])
    assert entry.get("type", "stdio") == "stdio"
    assert all(isinstance(entry[name], int) and entry[name] > 0 for name in entry if name.endswith("_timeout_sec"))


def test_the_plugin_and_its_list_have_the_form_of_claude_code() -> None:
    plugin = json.loads((HOSTS / "claude-code" / ".claude-plugin" / "plugin.json").read_text())
    market = json.loads((ROOT / ".claude-plugin" / "marketplace.json").read_text())
    assert set(plugin) <= FIELDS["plugin"]
    assert set(market) <= FIELDS["marketplace"]
    assert market["owner"]["name"]
    for listed in market["plugins"]:
        assert set(listed) <= FIELDS["listed"]
        assert listed["source"].startswith("./")
        assert ".." not in Path(listed["source"]).parts
        there = json.loads((ROOT / listed["source"] / ".claude-plugin" / "plugin.json").read_text())
        assert there["name"] == listed["name"]
    assert KEBAB.fullmatch(plugin["name"])
    assert KEBAB.fullmatch(market["name"])
    assert re.fullmatch(r"\d+\.\d+\.\d+", plugin["version"])


def test_the_skill_begins_with_a_name_and_a_description_that_hosts_accept() -> None:
    """https://agentskills.io/specification: the name is that of its folder."""
    path = HOSTS / "claude-code" / "skills" / "articad" / "SKILL.md"
    head = re.match(r"---\nname: (.+)\ndescription: (.+)\n---\n", path.read_text())
    assert head
    name, description = head.groups()
    assert name == path.parent.name
    assert KEBAB.fullmatch(name)
    assert len(name) <= 64
    assert len(description) <= 1024
    assert not re.search(r"[<>]|: ", description)  # plain YAML


def test_the_places_that_the_guide_names_exist() -> None:
    guide = (ROOT / "docs" / "how-to" / "coding-agents.md").read_text()
    named = re.findall(r"`(integrations/[\w./-]+)`", guide)
    assert {"integrations/claude-code", "integrations/codex/config.toml", "integrations/cursor/mcp.json"} <= set(named)
    assert all((ROOT / place).exists() for place in named)
    market = json.loads((ROOT / ".claude-plugin" / "marketplace.json").read_text())
    assert f"/plugin install {market['plugins'][0]['name']}@{market['name']}" in guide


def test_the_server_makes_the_folder_of_designs_that_the_entries_name(tmp_path: Path) -> None:
    for entry in entries().values():
        Tools(tmp_path / entry["args"][-1])
    assert (tmp_path / "designs").is_dir()


def test_the_plugin_holds_the_skill_and_the_version_of_the_package() -> None:
    plugin = HOSTS / "claude-code"
    assert (plugin / "skills" / "articad" / "SKILL.md").read_text() == skill()
    assert json.loads((plugin / ".claude-plugin" / "plugin.json").read_text())["version"] == __version__
    (listed,) = json.loads((ROOT / ".claude-plugin" / "marketplace.json").read_text())["plugins"]
    assert (ROOT / listed["source"]).resolve() == plugin
