"""Minutes of fuzzing add up over days, and a change of a reader resets its own row alone."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.fuzz import ledger
from tests.fuzz.ledger import Ledger, digest, sources
from tests.fuzz.readers import READERS


def test_minutes_add_up_and_a_change_of_a_reader_resets_its_own_row(tmp_path: Path) -> None:
    file = tmp_path / "ledger.json"
    for found in (0, 1):
        for name in ("urdf", "stl"):
            Ledger(file, {"urdf": "a", "stl": "b"}).add(name, processor_s=30.0, inputs=10, coverage=5 + found, found=found)
    changed = Ledger(file, {"urdf": "c", "stl": "b"})
    assert changed.row("stl") == {"sources": "b", "processor_s": 60.0, "inputs": 20, "coverage": 6, "found": 1}
    assert changed.seconds("urdf") == 0.0
    changed.add("urdf", processor_s=1.0, inputs=1, coverage=1, found=0)
    assert json.loads(file.read_text())["urdf"]["processor_s"] == 1.0


def test_only_what_a_module_does_counts(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text('"""One."""\ndef f():\n    """Two."""\n    return 1\n')
    before = digest(["a.py"], tmp_path)
    (tmp_path / "a.py").write_text('"""Other."""\n\n\ndef f():  # a comment\n    """Words."""\n    return (1)\n')
    assert digest(["a.py"], tmp_path) == before
    (tmp_path / "a.py").write_text("def f():\n    return 2\n")
    assert digest(["a.py"], tmp_path) != before


@pytest.mark.parametrize("name", [name for name in READERS if name not in {"mjcf", "step", "assembly", "brep", "shape"}])
def test_a_reader_has_sources_of_its_own(name: str) -> None:
    """Readers that start processes are left out here: they take seconds."""
    assert sources(name), name
    assert not [module for module in sources(name) if module.startswith(("kinematics/", "connectors/"))]


def test_the_ledger_is_of_these_readers() -> None:
    assert set(json.loads(ledger.FILE.read_text())) <= set(READERS)
