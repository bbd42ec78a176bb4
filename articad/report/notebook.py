"""The page inside another page, for notebooks."""

from __future__ import annotations

from html import escape

from articad.assembly import Assembly
from articad.geometry.part import Part
from articad.report.page import report_page

_HEIGHT = 620  # pixels: model and sliders without scrolling on a laptop


def notebook_page(assembly: Assembly) -> str:
    """Return an element that shows the assembly's page; it can run its own script and save files, and access nothing else."""
    return (
        f'<iframe title="{escape(assembly.name)}" srcdoc="{escape(report_page(assembly))}" sandbox="allow-scripts allow-downloads" '
        f'style="width: 100%; height: {_HEIGHT}px; border: 1px solid #8888; border-radius: 6px"></iframe>'
    )


def notebook_part(part: Part) -> str:
    """Return an element that shows the page of a part alone."""
    return notebook_page(Assembly.from_parts(part.name, parts=[part], joints=[], ground=part.name))
