"""One self-contained page for each run or build: a movable model, and all reports about it."""

from articad.report.model import viewer_model
from articad.report.notebook import notebook_page
from articad.report.page import Documents, report_page

__all__ = ["Documents", "notebook_page", "report_page", "viewer_model"]
