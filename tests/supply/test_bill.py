"""The bill of materials lists what is locked, package by package, hash by hash; read here by another parser than the script's."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement

from articad import __version__

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def bill(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    file = tmp_path_factory.mktemp("bill") / "articad.cdx.json"
    subprocess.run([sys.executable, str(ROOT / "scripts/sbom"), str(file)], check=True)
    printed = subprocess.run([sys.executable, str(ROOT / "scripts/sbom")], check=True, capture_output=True).stdout
    assert printed == file.read_bytes()
    document: dict[str, Any] = json.loads(printed)
    return document


def test_every_locked_package_is_listed_with_all_its_hashes(bill: dict[str, Any]) -> None:
    locked = {}
    for entry in (ROOT / "requirements.lock").read_text().replace("\\\n", " ").splitlines():
        words = entry.partition("#")[0].strip()
        if words:
            requirement = Requirement(words.partition(" --hash")[0].strip())
            name = re.sub(r"[-_.]+", "-", requirement.name).lower()
            locked[name, str(requirement.specifier).removeprefix("==")] = set(re.findall(r"--hash=sha256:(\w+)", words))
    listed = {(one["name"], one["version"]): {digest["content"] for digest in one["hashes"]} for one in bill["components"]}
    assert len(listed) > 100
    assert listed == locked


def test_it_has_the_form_of_cyclonedx(bill: dict[str, Any]) -> None:
    assert (bill["bomFormat"], bill["specVersion"], bill["version"]) == ("CycloneDX", "1.6", 1)
    assert re.fullmatch(r"urn:uuid:[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}", bill["serialNumber"])
    root = bill["metadata"]["component"]
    assert (root["type"], root["name"], root["version"]) == ("application", "articad", __version__)
    references = [root["bom-ref"], *(one["bom-ref"] for one in bill["components"])]
    assert len(set(references)) == len(references)
    for one in bill["components"]:
        assert one["type"] == "library"
        assert one["purl"] == f"pkg:pypi/{one['name']}@{one['version']}"
        assert all(digest["alg"] == "SHA-256" and re.fullmatch("[0-9a-f]{64}", digest["content"]) for digest in one["hashes"])
