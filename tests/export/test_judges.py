"""Outside judges have no objection to exports; see `judges.py` for their environment, and for the table of all examples."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from articad.entry import read
from tests.export import judges


@pytest.mark.engines_all
@pytest.mark.skipif(not judges.PYTHON, reason="ARTICAD_ENGINES names no Python with Newton and validators")
@pytest.mark.parametrize("name", ["wardrobe", "sewing_things_box"])
def test_no_judge_objects_to_an_example(name: str, tmp_path: Path) -> None:
    assembly = read(judges.folder_of(name))
    said = {judge: ask() for judge, ask in judges.judges_of(assembly, judges.exported(assembly, tmp_path)).items()}

    assert {judge: one.words for judge, one in said.items() if one.passed is False} == {}


def test_the_page_is_what_the_record_says() -> None:
    record = json.loads(judges.RECORD.read_text())

    assert set(record) <= {*judges.example_names(), *judges.hard_names()}
    assert judges.PAGE.read_text() == judges.page(record)


def test_readme_says_what_the_record_says() -> None:
    record = json.loads(judges.RECORD.read_text())
    text = judges.README.read_text()

    assert judges.summary(record) in text
    assert judges.readme(text, record) == text
    changed = json.loads(json.dumps(record))
    changed["four_bar"]["MuJoCo mjcf"] |= {"passed": False, "words": "diverges"}
    assert "not four_bar" in judges.readme(text, changed)
