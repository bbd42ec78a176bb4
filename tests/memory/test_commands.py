"""`articad memory`: filled from the examples, looked into, thinned out, carried elsewhere."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad import cli, examples

Told = pytest.CaptureFixture[str]


def report(told: Told, *arguments: str, code: int = 0) -> dict[str, Any]:
    assert cli.main(["memory", *arguments, "--json"]) == code
    return dict(json.loads(told.readouterr().out))


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ARTICAD_MEMORY", str(tmp_path / "memory"))
    return tmp_path / "memory"


def test_it_is_shipped_empty_and_seeded_once(store: Path, capsys: Told) -> None:
    assert report(capsys, "list")["cases"] == []
    assert not store.exists()
    assert report(capsys, "seed")["added"] == len(examples.names())
    assert report(capsys, "seed")["added"] == 0
    assert report(capsys, "search", "a closet with two doors")["hits"][0]["prompt"].startswith("Wardrobe")


def test_a_case_is_shown_carried_and_forgotten(store: Path, capsys: Told, tmp_path: Path) -> None:
    report(capsys, "seed")
    name = report(capsys, "list")["cases"][0]["id"]
    assert report(capsys, "show", name[:6])["case"]["schema"] == "articad.case/1"
    file = str(tmp_path / "cases.jsonl")
    assert report(capsys, "export", file)["count"] == len(examples.names())
    assert report(capsys, "remove", name)["removed"] == name
    assert report(capsys, "prune", "--keep", "2")["removed"] == len(examples.names()) - 3
    assert report(capsys, "import", file)["added"] == len(examples.names()) - 2


@pytest.mark.parametrize("arguments", [["show"], ["show", "no such case"], ["import", "/nowhere"]])
def test_what_cannot_be_done_is_said(store: Path, capsys: Told, arguments: list[str]) -> None:
    assert report(capsys, *arguments, code=3)["ok"] is False
    assert not store.exists()
