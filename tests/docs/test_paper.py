"""The page on the paper names only modules and tests that exist, and marks every number that is not ours."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
TEXT = (ROOT / "docs" / "paper.md").read_text()
MODULES = sorted(set(re.findall(r"`(articad(?:\.[a-z_0-9]+)+)`", TEXT)))
TESTS = sorted(set(re.findall(r"`(tests/[a-z_0-9/]+\.py(?:::[a-z_0-9]+)?)`", TEXT)))
IDS = re.findall(r"^\| ([A-Z][a-z]*\.? ?\d+) \|", TEXT, re.MULTILINE)


def test_the_page_lists_claims_equations_and_tables() -> None:
    assert len(IDS) == len(set(IDS))
    assert {f"Eq. {n}" for n in range(1, 5)} <= set(IDS)
    assert len(IDS) >= 30
    assert re.findall(r"^\*\*T(\d)\.", TEXT, re.MULTILINE) == ["1", "2", "3", "4"]


@pytest.mark.parametrize("module", MODULES)
def test_each_module_exists(module: str) -> None:
    path = ROOT / Path(*module.split("."))
    assert path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


@pytest.mark.parametrize("test", TESTS)
def test_each_test_exists(test: str) -> None:
    file, _, function = test.partition("::")
    tree = ast.parse((ROOT / file).read_text())
    names = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    assert not function or function in names


def test_every_claim_names_a_module_and_a_test_or_says_that_there_is_none() -> None:
    for line in TEXT.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 5 and cells[0] in IDS:
            _, _, module, test, difference = cells
            assert (("`articad." in module or "`articad_bench." in module) and "`tests/" in test) or (
                module == test == "–" and re.search(r"not here yet|not measured by us", difference)
            ), line


def test_every_table_of_numbers_is_marked_as_the_papers() -> None:
    titles = re.findall(r"^\*\*T\d\. (.*)\*\*$", TEXT, re.MULTILINE)
    assert all("(the paper's, not measured by us)" in title for title in titles)
