"""The container and the bill of materials say what the lock says; neither needs a network to be checked."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.supply.test_lock import LOCK, ROOT, entries

DOCKERFILE = (ROOT / "Dockerfile").read_text()


def bill() -> dict[str, Any]:
    done = subprocess.run([sys.executable, str(ROOT / "scripts" / "sbom")], capture_output=True, text=True, check=True)
    document: dict[str, Any] = json.loads(done.stdout)
    return document


def test_the_bill_names_every_locked_package_with_its_hashes() -> None:
    components = bill()["components"]
    # a package may be locked in two versions, for different Pythons
    pinned = re.findall(r"^([A-Za-z0-9._-]+)==([^\s;\\]+)", LOCK, re.MULTILINE)
    assert sorted((re.sub(r"[-_.]+", "-", name).lower(), version) for name, version in pinned) == sorted(
        (component["name"], component["version"]) for component in components
    )
    assert {component["name"] for component in components} >= {re.sub(r"[-_.]+", "-", name) for name in entries()}
    assert all(component["hashes"] and component["purl"].startswith("pkg:pypi/") for component in components)
    assert sum(len(component["hashes"]) for component in components) == LOCK.count("--hash=sha256:")


def test_the_bill_is_the_same_each_time_and_has_the_form_of_cyclonedx() -> None:
    first = bill()
    assert first == bill()
    assert (first["bomFormat"], first["specVersion"], first["version"]) == ("CycloneDX", "1.6", 1)
    assert re.fullmatch(r"urn:uuid:[0-9a-f-]{36}", first["serialNumber"])
    refs = [component["bom-ref"] for component in first["components"]]
    assert len(refs) == len(set(refs))


def test_the_container_installs_by_hash_and_runs_as_nobody_special() -> None:
    lines = [line for line in DOCKERFILE.splitlines() if not line.startswith("#")]
    assert any("--require-hashes" in line and "requirements.lock" in line for line in lines)
    assert any("--no-deps" in line and "/src" in line for line in lines)
    users = [line.split()[1] for line in lines if line.startswith("USER")]
    assert users
    assert users[-1] not in {"root", "0"}
    assert not any(line.startswith(("ADD", "COPY .")) or "curl" in line or "ARTICAD_SANDBOX" in line for line in lines)
    for name in re.findall(r"^COPY (.+) \S+$", DOCKERFILE, re.MULTILINE):
        assert all((ROOT / word).exists() for word in name.split())


def test_the_container_takes_nothing_but_what_is_named() -> None:
    rules = (ROOT / ".dockerignore").read_text().split()
    assert rules[0] == "*"
    assert "**/.env" in rules


def test_the_words_on_running_it_leave_no_network_and_no_privilege() -> None:
    words = DOCKERFILE + (ROOT / "SECURITY.md").read_text()
    for flag in ("--network none", "--cap-drop ALL", "no-new-privileges", "--read-only", "--memory", "--pids-limit"):
        assert flag in DOCKERFILE
    assert "Dockerfile" in words


def test_nothing_in_the_repository_is_an_env_file() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout.split()
    assert not [name for name in listed if Path(name).name.startswith(".env")]
