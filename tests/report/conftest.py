"""A browser for the tests of the page: the distribution's Chromium, driven by Playwright, with the network refused."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--no-sandbox", "--force-color-profile=srgb", "--hide-scrollbars"]


@dataclass
class Opened:
    """A page that is open, and everything it said or asked for."""

    page: Any
    console: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def __call__(self, script: str, argument: Any = None) -> Any:
        return self.page.evaluate(script, argument)


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    api = pytest.importorskip("playwright.sync_api", reason="Playwright is missing: pip install 'articad[test]'")
    if CHROMIUM is None:
        pytest.skip("Chromium is missing: as root, apt-get install chromium (./scripts/setup does)")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def open_page(chromium: Any, tmp_path: Path) -> Iterator[Callable[..., Opened]]:
    """Open a page's text from a file, and wait until its model is drawn."""
    contexts: list[Any] = []

    def open_text(text: str, *, width: int = 1200, height: int = 800, scheme: str = "light", phone: bool = False) -> Opened:
        file = tmp_path / f"page{len(contexts)}.html"
        file.write_text(text, encoding="utf-8")
        context = chromium.new_context(
            viewport={"width": width, "height": height}, color_scheme=scheme, device_scale_factor=1, has_touch=phone, is_mobile=phone
        )
        contexts.append(context)
        opened = Opened(context.new_page())
        opened.page.on("console", lambda message: opened.console.append(f"{message.type}: {message.text}"))
        opened.page.on("pageerror", lambda error: opened.console.append(f"error: {error}"))
        opened.page.on("request", lambda request: opened.requests.append(request.url))
        opened.page.goto(file.as_uri())
        opened.page.wait_for_selector("html[data-ready]", state="attached", timeout=60_000)
        return opened

    yield open_text
    for context in contexts:
        context.close()
