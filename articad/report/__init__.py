"""One self-contained page for each run or build: a movable model, and all reports about it.

`page.py` writes the page, `sections.py` its parts, `tables.py` draws every table; `model.py` and `drawing.py` give joints and meshes to `viewer/`.
"""

from articad.report.model import viewer_model
from articad.report.notebook import notebook_page, notebook_part
from articad.report.page import Documents, report_page

__all__ = ["Documents", "notebook_page", "notebook_part", "report_page", "viewer_model"]
