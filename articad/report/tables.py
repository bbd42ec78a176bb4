"""Tables as HTML, every text escaped: for reports and notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import NamedTuple


class Html(NamedTuple):
    """Trusted markup, which is not escaped again."""

    text: str


Cell = str | int | float | None | Html


def html_text(cell: Cell) -> str:
    """Return a cell's markup: texts escaped, numbers with six significant digits, empty for None."""
    if isinstance(cell, Html):
        return cell.text
    if isinstance(cell, float):
        return f"{cell:.6g}"
    return "" if cell is None else escape(str(cell))


def html_table(columns: Sequence[str], rows: Iterable[Sequence[Cell]], *, numbers: Sequence[int] = ()) -> str:
    """Return a table; empty if there are no rows.

    Args:
        columns: Headings.
        rows: Cells.
        numbers: Indices of numeric columns.
    """
    kind = [' class="number"' if index in numbers else "" for index in range(len(columns))]
    label = [f' data-label="{escape(column)}"' if column else "" for column in columns]  # shown where the table becomes cards
    body = "".join(
        "<tr>" + "".join(f"<td{kind[index]}{label[index]}>{html_text(cell)}</td>" for index, cell in enumerate(row)) + "</tr>\n"
        for row in rows
    )
    if not body:
        return ""
    head = "".join(
        (f'<th scope="col"{kind[index]}>{escape(column)}</th>' if column else "<td></td>") for index, column in enumerate(columns)
    )
    return f"<table><thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table>\n"
