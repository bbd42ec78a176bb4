"""A hook of MkDocs: adds to the site each example as a page with a slider for every driver, `live/<name>.html`.

A page is made once for each state of the plan, the scripts and the viewer, and kept in the cache of parts.
"""

from __future__ import annotations

import hashlib
import json
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
    """Return the page of an example; it is made where it is not there yet, and its checks are not run again for another look of the page."""
    sources = [folder / "plan.json", *sorted((folder / "parts").glob("*.py"))]
    looks = [*sorted(REPORT.glob("*.py")), *sorted(REPORT.glob("viewer.*"))]
    checks = _file(f"{folder.name}-{_digest(sources)}.json")
    page = _file(f"{folder.name}-{_digest([*sources, *looks])}.html")
    if not page.is_file():
        plan = AssemblyPlan.load(folder)
        assembly = Assembly.from_plan(plan, folder / "parts")
        if not checks.is_file():
            _write(checks, json.dumps(assembly.check().to_json()))
        report = json.loads(checks.read_text(encoding="utf-8"))
        _write(page, report_page(assembly, Documents(checks=report, plan=plan.dumps())))
    return page


def _digest(sources: list[Path]) -> str:
    digest = hashlib.sha256(__version__.encode())
    for source in sources:
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _file(name: str) -> Path:
    return default_root() / "pages" / name


def _write(file: Path, text: str) -> None:
    """Write a file whole or not at all: another process may be reading."""
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(".tmp")
    unfinished.write_text(text, encoding="utf-8")
    unfinished.rename(file)


def on_files(files: Any, *, config: Any) -> Any:
    """Add the pages to the site."""
    for plan in sorted((ROOT / "examples").glob("*/plan.json")):
        files.append(File.generated(config, f"live/{plan.parent.name}.html", abs_src_path=str(live_page(plan.parent))))
    return files
