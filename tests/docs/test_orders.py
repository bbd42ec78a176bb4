"""The stored orders of assembly: the page is current, paths are free where they were sampled, and only blockers are told of pictures."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "orders.py"


@pytest.fixture(scope="module")
def orders() -> ModuleType:
    spec = importlib.util.spec_from_file_location("orders_script", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def stored(orders: ModuleType) -> dict[str, Any]:
    return dict(orders.stored_results())


def test_the_page_is_that_of_the_stored_results(orders: ModuleType) -> None:
    assert orders.PAGE.read_text(encoding="utf-8") == orders.stored_page()


def test_every_path_is_free_where_it_was_sampled(stored: dict[str, Any]) -> None:
    for key, row in stored["rows"].items():
        sampled = row["sampled"]
        assert sampled["worst_mm"] is None or sampled["worst_mm"] <= 1e-6, key
        assert (sampled["places"] > 0) == (row["steps"] > 1), key


def test_what_is_told_of_pictures_is_of_products_that_are_blocked(orders: ModuleType, stored: dict[str, Any]) -> None:
    assert {*orders.LOOKED, *orders.REFUTED} <= {key for key, row in stored["rows"].items() if row["blocked"]}
    assert not set(orders.LOOKED) & set(orders.REFUTED)


def test_a_product_that_changed_has_another_digest(orders: ModuleType, tmp_path: Path) -> None:
    product = orders.Product("one", tmp_path, recorded=False)
    (tmp_path / "plan.json").write_text("{}")
    before = product.digest
    (tmp_path / "plan.json").write_text('{"name": "one"}')
    assert product.digest != before


def test_results_of_earlier_programs_are_marked(orders: ModuleType, stored: dict[str, Any]) -> None:
    rows = {"one": next(iter(stored["rows"].values())) | {"programs": "before", "blocked": []}}
    told = orders.page({"programs": "now", "planned": ["one", "two"], "rows": rows})
    assert "(earlier programs)" in told
    assert "Not examined yet: `two`." in told
