"""The parts list (ISO 7573) as CSV, JSON and XLSX."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Final

from articad.aliases import Json
from articad.errors import ArticadError
from articad.papers import EXTRA
from articad.papers.items import Item

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["COLUMNS", "bill_json", "bill_xlsx", "rows_of", "written_csv"]

COLUMNS: Final = (
    "item", "name", "quantity", "material", "mass_kg", "total_kg", "x_mm", "y_mm", "z_mm", "supply", "description", "note", "parts",
)  # fmt: skip
_WIDTHS: Final = (6, 24, 9, 18, 10, 10, 9, 9, 9, 11, 50, 28, 40)  # characters
_DATE: Final = datetime(2000, 1, 1, tzinfo=UTC)  # equal content gives equal bytes
_LONGEST: Final = 32_767  # UTF-16 units of a cell: Microsoft, Excel specifications and limits
_HIDDEN: Final = (
    '\\s"\x00-\x20\x7f-\xa0\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2000-\u200f\u2028-\u202f\u205f-\u206f\u2800\u3000'
    "\u3164\ufe00-\ufe0f\ufeff\uffa0\ufff0-\ufffc\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
)  # what a program for tables may pass over: quotation marks, and Unicode's White_Space, control characters and Default_Ignorable_Code_Point
_COMPUTED: Final = "=+\\-@\u207a-\u207c\u208a-\u208c\u2212\ufe62\ufe63\ufe66\ufe6b\uff1d\uff0b\uff0d\uff20"  # and their other widths
_FORMULA: Final = re.compile(f"((?:;|(?<![{_HIDDEN};])))([{_HIDDEN}]*+)(?=[{_COMPUTED}])")


def rows_of(items: Sequence[Item]) -> list[tuple[Any, ...]]:
    """Return the rows of a table with `COLUMNS`: lengths in mm, masses in kg, None for what is not known."""
    return [
        (
            item.number, item.name, item.quantity, item.material, item.mass_kg, item.total_kg, *(item.size_mm or (None,) * 3),
            item.supply, item.description, item.note, " ".join(item.parts),
        )
        for item in items
    ]  # fmt: skip


def bill_json(assembly: Assembly, items: Sequence[Item]) -> Json:
    """Return the report `articad.bom/1`. `mass_kg` is the mass of all parts whose mass is known, `without_mass` names the others."""
    product = assembly.product()
    masses = [part.mass.mass for part in product.parts.values() if part.mass is not None]
    keys = COLUMNS[: COLUMNS.index("parts")]
    return {
        "schema": "articad.bom/1",
        "ok": True,
        "assembly": assembly.name,
        "parts": len(product.parts),
        "mass_kg": sum(masses),
        "without_mass": [name for name, part in product.parts.items() if part.mass is None],
        "items": [
            dict(zip(keys, row, strict=False)) | {"parts": list(item.parts)} for item, row in zip(items, rows_of(items), strict=True)
        ],
        "findings": [],
    }


def written_csv(header: Sequence[str], rows: Sequence[Sequence[Any]]) -> bytes:
    """Return a table as CSV (RFC 4180, UTF-8). Numbers have up to 6 digits; texts that programs would compute get an apostrophe."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream)
    writer.writerow(header)
    for row in rows:
        writer.writerow([_cell(value) for value in row])
    return stream.getvalue().encode()


def bill_xlsx(assembly: Assembly, items: Sequence[Item]) -> bytes:
    """Return the parts list as a workbook, with the sums as formulas.

    Raises:
        ArticadError: If XlsxWriter is not installed.
    """
    if find_spec("xlsxwriter") is None:
        raise ArticadError(f"XLSX needs XlsxWriter, which is not installed. Run: {EXTRA}; or write CSV.", stage="export")
    import xlsxwriter  # noqa: PLC0415 - an extra

    stream, rows = io.BytesIO(), rows_of(items)
    book = xlsxwriter.Workbook(stream, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False})
    book.set_properties({"title": f"{assembly.name}: parts list", "created": _DATE})
    sheet = book.add_worksheet("Parts")
    bold, text = book.add_format({"bold": True, "bottom": 1}), book.add_format({"text_wrap": True, "valign": "top"})
    mass, size = (book.add_format({"num_format": form, "valign": "top"}) for form in ("0.0000", "0.##"))
    for column, (name, width) in enumerate(zip(COLUMNS, _WIDTHS, strict=True)):
        sheet.set_column(column, column, width)
        sheet.write_string(0, column, name, bold)
    for index, row in enumerate(rows, start=1):
        for column, (name, value) in enumerate(zip(COLUMNS, row, strict=True)):
            if isinstance(value, str):
                sheet.write_string(index, column, _shortened(value), text)
            elif value is not None:
                sheet.write_number(index, column, value, mass if name.endswith("_kg") else size)
    last = len(rows) + 1
    sheet.write_string(last, COLUMNS.index("name"), "Total", bold)
    for name, total in (("quantity", sum(item.quantity for item in items)), ("total_kg", sum(item.total_kg or 0.0 for item in items))):
        column = COLUMNS.index(name)
        letter = chr(ord("A") + column)
        sheet.write_formula(last, column, f"=SUM({letter}2:{letter}{last})", mass if name == "total_kg" else size, total)
    sheet.freeze_panes(1, 2)
    book.close()
    return stream.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    words = _FORMULA.sub(_guarded, str(value))
    return f"'{words}" if words[:1].isspace() else words


def _guarded(found: re.Match[str]) -> str:
    """Return what stands before a character that begins a formula, with an apostrophe wherever a cell may begin there.

    A cell begins with the text; and after a semicolon, a tab or the end of a line where another country's program separates cells by these.
    """
    end = 1 + max(found[2].rfind(sign) for sign in "\t\r\n")
    first, last = (f"'{found[2][:end]}" if found.start() == 0 or found[1] else found[2][:end]), found[2][end:]
    again = "'" if end else ""
    return f"{found[1]}{first}{again}{last}"


def _shortened(text: str) -> str:
    """Return what a cell of a workbook holds of a text: all of it, or its first words and how much is left out."""
    if len(text.encode("utf-16-le")) // 2 <= _LONGEST:
        return text
    told = " … ({} more characters, which CSV and JSON hold)"
    room = _LONGEST - len(told.format(len(text)))
    begun = text.encode("utf-16-le")[: 2 * room].decode("utf-16-le", "ignore")  # not half of a pair
    begun = begun[: begun.rfind(" ")] if " " in begun else begun
    return begun + told.format(len(text) - len(begun))
