"""A hook of MkDocs: adds to the site each example as a page with a slider for every driver, `live/<name>.html`.

A page is made once for each state of the plan, the scripts and the viewer, and kept in the cache of parts.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

from articad import __version__
from articad.assembly import Assembly
from articad.kernels.cache import default_root
from articad.plan.schema import AssemblyPlan
from articad.report import Documents, report_page

ROOT = Path(__file__).resolve().parents[1]
REPORT = ROOT / "articad" / "report"


def live_page(folder: Path) -> Path:
    """Return the page of an example; it is made where it is not there yet."""
    sources = [
        folder / "plan.json",
        *sorted((folder / "parts").glob("*.py")),
        *sorted(REPORT.glob("*.py")),
        *sorted(REPORT.glob("viewer.*")),
    ]
    digest = hashlib.sha256(__version__.encode())
    for source in sources:
        digest.update(source.read_bytes())
    page = default_root() / "pages" / f"{folder.name}-{digest.hexdigest()[:16]}.html"
    if not page.is_file():
        plan = AssemblyPlan.load(folder)
        assembly = Assembly.from_plan(plan, folder / "parts")
        text = report_page(assembly, Documents(checks=assembly.check().to_json(), plan=plan.dumps()))
        page.parent.mkdir(parents=True, exist_ok=True)
        unfinished = page.with_suffix(".tmp")
        unfinished.write_text(text, encoding="utf-8")
        unfinished.rename(page)
    return page


def on_files(files: Any, *, config: Any) -> Any:
    """Add the pages to the site."""
    for plan in sorted((ROOT / "examples").glob("*/plan.json")):
        files.append(File.generated(config, f"live/{plan.parent.name}.html", abs_src_path=str(live_page(plan.parent))))
    return files
