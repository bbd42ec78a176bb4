"""Takes the picture of a report for the documentation: docs/images/report.png. Look at it before you commit it.

.venv/bin/python scripts/screenshot.py
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.report.conftest import FLAGS  # noqa: E402
from tests.report.test_page import KEPT, showcase  # noqa: E402


def main() -> int:
    """Take the picture."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        file = Path(folder, "report.html")
        file.write_text(showcase(), encoding="utf-8")
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": 1200, "height": 760})
        page.goto(file.as_uri())
        page.wait_for_selector("html[data-ready]", state="attached")
        page.wait_for_function("() => articad.view.settled")
        page.screenshot(path=KEPT)
        browser.close()
    print(KEPT.relative_to(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
