"""The gallery shows every example, with its sheet and a page that moves."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
NAMES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/plan.json"))


@pytest.mark.parametrize("name", NAMES)
def test_an_example_has_its_sheet_and_its_moving_page(name: str) -> None:
    text = (ROOT / "docs" / "gallery.md").read_text()
    assert f"(images/gallery/{name}.png)" in text
    assert f"(live/{name}.html)" in text
    assert (ROOT / "docs" / "images" / "gallery" / f"{name}.png").is_file()


def test_readme_and_home_open_with_a_picture_that_moves_and_loads_at_once() -> None:
    file = ROOT / "docs" / "images" / "moving.gif"

    assert f"({file.relative_to(ROOT).as_posix()})" in (ROOT / "README.md").read_text()[:300]
    assert "live/desk_lamp.html" in (ROOT / "docs" / "index.md").read_text()[:600]
    assert file.stat().st_size <= 3_000_000
    with Image.open(file) as picture:
        assert getattr(picture, "n_frames", 1) >= 12
        first = np.asarray(picture.convert("RGB")).astype(int)
        picture.seek(getattr(picture, "n_frames", 1) // 3)
        later = np.asarray(picture.convert("RGB")).astype(int)
    moved = np.abs(first - later).max(axis=2) > 60
    assert all(panel.mean() > 0.005 for panel in np.array_split(moved, 3, axis=1)), "each of the three products moves"


def test_home_opens_with_the_lamp_and_every_other_live_model_is_one_click_away() -> None:
    home = (ROOT / "docs" / "index.md").read_text()

    assert home.index("live/desk_lamp.html#moving") < home.index("./scripts/demo")
    for name in NAMES:
        assert f'"live/{name}.html' in home
        if name != "desk_lamp":
            with Image.open(ROOT / "docs" / "images" / "live" / f"{name}.png") as picture:
                assert picture.size == (360, 270)
                alpha = np.asarray(picture.convert("RGBA"))[..., 3]
            assert 0.05 < (alpha > 250).mean() < 0.9, "a model on no background"


def test_the_badges_are_true() -> None:
    """They are drawn from pyproject.toml, and a reader of it by hand finds the same."""
    spec = importlib.util.spec_from_file_location("badges", ROOT / "scripts" / "badges.py")
    assert spec is not None
    assert spec.loader is not None
    badges = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(badges)

    assert badges.main(["--check"]) == 0
    drawn, project = (ROOT / "docs" / "images" / "badges.svg").read_text(), (ROOT / "pyproject.toml").read_text()
    assert "≥ 3.11" in drawn
    assert 'requires-python = ">=3.11"' in project
    assert "Apache-2.0" in drawn
    assert "Apache License" in (ROOT / "LICENSE").read_text()[:300]


def test_the_sites_hook_makes_a_page_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path))
    spec = importlib.util.spec_from_file_location("live_pages", ROOT / "scripts" / "live_pages.py")
    assert spec is not None
    assert spec.loader is not None
    hook = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hook)

    page = hook.live_page(ROOT / "examples" / "four_bar")

    assert '"drivers":[{"kind":"plain","name":"crank"' in page.read_text().replace("\\u0022", '"')
    made = page.stat().st_mtime_ns
    assert hook.live_page(ROOT / "examples" / "four_bar").stat().st_mtime_ns == made
