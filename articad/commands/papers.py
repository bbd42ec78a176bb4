"""Write the papers that a workshop needs: the parts list, the cut list, drawings, and the assembly manual."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from articad.commands.assembling import FASTEN
from articad.commands.command import argument, closest, command, output_folder
from articad.commands.options import SANDBOX, amount, names
from articad.commands.steps import loaded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from articad.commands.terminal import Report, Terminal
    from articad.papers.sheet import DrawingSheet

BILLS: Final = ("csv", "json", "xlsx")
DRAWINGS: Final = ("svg", "pdf", "dxf")
MANUALS: Final = ("pdf", "svg", "html")
_ASSEMBLY: Final = "assembly"  # name of the drawing of all parts, after the product's name; no drawing of a part has it
PURCHASED = argument("--purchased", metavar="NAMES", type=names, default=(), help="parts that are bought; * and ? are wildcards")
PAPERS_OUT = output_folder("--out", "papers", "where to write")


def bills(text: str) -> tuple[str, ...]:
    """Read `csv,xlsx`."""
    return _chosen(text, BILLS)


def drawings(text: str) -> tuple[str, ...]:
    """Read `svg,dxf`."""
    return _chosen(text, DRAWINGS)


def manuals(text: str) -> tuple[str, ...]:
    """Read `pdf,html`."""
    return _chosen(text, MANUALS)


def _chosen(text: str, known: tuple[str, ...]) -> tuple[str, ...]:
    chosen = names(text)
    for name in chosen:
        if name not in known:
            raise argparse.ArgumentTypeError(f"unknown format {name!r}{closest(name, known)}; there are {', '.join(known)}")
    return chosen


def rectangle(text: str) -> tuple[float, float]:
    """Read `2440x1220`: two positive lengths."""
    first, sign, second = text.lower().partition("x")
    if not sign:
        raise argparse.ArgumentTypeError(f"{text!r} is not a size such as 2440x1220")
    return amount(first), amount(second)


def _kerf(text: str) -> float:
    try:
        return 0.0 if float(text) == 0.0 else amount(text)
    except ValueError:
        return amount(text)


@command(
    "bom",
    "Write the parts list of a run, a plan or a file: items, quantities, materials, masses and sizes; with --cuts also a cut list.",
    argument("target", metavar="RUN|PLAN_DIR|FILE"),
    argument("--to", metavar="FORMATS", dest="bills", type=bills, default=("csv", "json"), help="csv, json, xlsx (csv,json)"),
    PURCHASED,
    argument("--cuts", action="store_true", help="also write a cut list: parts that are boards, placed on sheets"),
    argument(
        "--sheet", metavar="LxW", type=rectangle, default=(2440.0, 1220.0), help="size of a sheet in mm, first along the grain (2440x1220)"
    ),
    argument("--kerf", metavar="MM", type=_kerf, default=3.2, help="width of a saw cut (3.2)"),
    argument("--turn", action="store_true", help="let boards lie across the grain"),
    PAPERS_OUT,
    SANDBOX,
)
def _bom(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.export.names import file_name
    from articad.papers.bill import COLUMNS, bill_json, bill_xlsx, rows_of, written_csv
    from articad.papers.items import items_of

    assembly = loaded(options.target, options, terminal)
    items = items_of(assembly, options.purchased)
    report = bill_json(assembly, items)
    files: dict[str, bytes] = {}
    stem = file_name(assembly.name)  # a file of somebody else may give any name
    if options.cuts:
        report["cuts"], text, table = _cut_list(assembly, items, options)
        files |= {f"{stem}_cuts.txt": text.encode(), f"{stem}_cuts.csv": table}
    for name in options.bills:
        files[f"{stem}_bom.{name}"] = (
            bill_xlsx(assembly, items)
            if name == "xlsx"
            else written_csv(COLUMNS, rows_of(items))
            if name == "csv"
            else (json.dumps(report, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()
        )
    terminal.table(
        ("item", "name", "quantity", "material", "kg", "kg in all", "x × y × z, mm"),
        [
            (
                i.number,
                i.name,
                i.quantity,
                i.material or "-",
                _kg(i.mass_kg),
                _kg(i.total_kg),
                " × ".join(f"{s:.5g}" for s in i.size_mm or ()),
            )
            for i in items
        ],
        right=(0, 2, 4, 5),
    )
    unknown = report["without_mass"]
    terminal.say(
        f"{assembly.name}: {report['parts']} parts, {len(items)} items, {report['mass_kg']:.4g} kg"
        + (f" without {', '.join(unknown)}, whose mass is not known." if unknown else ".")
    )
    if options.cuts:
        terminal.text(text)
    return report | {"files": _written(files, options, terminal)}


@command(
    "drawing",
    "Draw a run or a plan for a workshop: a sheet with balloons and parts list, and a dimensioned sheet of each item, or of one part.",
    argument("target", metavar="RUN|PLAN_DIR"),
    argument("part", metavar="PART", nargs="?", help="draw the sheet of this part only"),
    argument("--to", metavar="FORMATS", dest="drawings", type=drawings, default=("svg", "dxf"), help="svg, pdf, dxf (svg,dxf)"),
    argument("--size", choices=["A4", "A3"], default=None, help="size of the sheets of parts (A4, or A3 where that is too small)"),
    PURCHASED,
    PAPERS_OUT,
    SANDBOX,
)
def _drawing(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands.steps import sandbox_level
    from articad.export.names import file_name, file_names
    from articad.papers.drawing import drawings_of
    from articad.papers.sheet import A3, A4
    from articad.papers.writers import require_pdf, written_dxf, written_pdf, written_svg

    if "pdf" in options.drawings:
        require_pdf()
    assembly = loaded(options.target, options, terminal)
    size = {"A4": A4, "A3": A3, None: None}[options.size]
    sheets = _drawn(drawings_of(assembly, options.part, purchased=options.purchased, size=size, sandbox=sandbox_level(options)), terminal)
    stem = file_name(assembly.name)
    files: dict[str, bytes] = {}
    parts = file_names(assembly.product().parts, (_ASSEMBLY, *(_page(number) for number in range(1, 1000))))
    for sheet in sheets:
        name = f"{stem}_{parts[sheet.part] if sheet.part else _ASSEMBLY}"
        if "svg" in options.drawings:
            files[f"{name}.svg"] = written_svg(sheet)
        if "dxf" in options.drawings:
            files[f"{name}.dxf"] = written_dxf(sheet)
    if "pdf" in options.drawings:
        files[f"{stem}{'' if options.part is None else f'_{parts[options.part]}'}_drawings.pdf"] = written_pdf(sheets, assembly.name)
    return {
        "schema": "articad.drawings/1",
        "ok": True,
        "sheets": [sheet.told for sheet in sheets],
        "files": _written(files, options, terminal),
        "findings": [],
    }


@command(
    "manual",
    "Write an assembly manual: a page for each step, exploded along its proven path, and a page on which each step can be played.",
    argument("target", metavar="RUN|PLAN_DIR|FILE"),
    argument("--to", metavar="FORMATS", dest="manuals", type=manuals, default=("pdf", "html"), help="pdf, svg, html (pdf,html)"),
    FASTEN,
    PURCHASED,
    PAPERS_OUT,
    SANDBOX,
)
def _manual(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands import summaries
    from articad.export.names import file_name
    from articad.papers.items import items_of
    from articad.papers.manual import manual_of
    from articad.papers.writers import require_pdf, written_pdf, written_svg

    if "pdf" in options.manuals:
        require_pdf()
    assembly = loaded(options.target, options, terminal)
    items = items_of(assembly, options.purchased)
    with terminal.progress("Taking apart"):
        order = assembly.assembly_order(options.fasten)
    report = order.to_json()
    stem = file_name(assembly.name)  # a file of somebody else may give any name
    sheets = _drawn(manual_of(assembly, order, items), terminal) if {"pdf", "svg"} & set(options.manuals) else []
    files: dict[str, bytes] = {}
    if "pdf" in options.manuals:
        files[f"{stem}_manual.pdf"] = written_pdf(sheets, f"{assembly.name}: assembly manual")
    if "svg" in options.manuals:
        files |= {f"{stem}_{_page(number)}.svg": written_svg(sheet) for number, sheet in enumerate(sheets, start=1)}
    if "html" in options.manuals:
        files[f"{stem}_manual.html"] = _played(options.target, assembly, report).encode()
    summaries.print_order(report, terminal)
    summaries.print_findings(report["findings"], terminal)
    return {
        "schema": "articad.manual/1",
        "ok": order.ok,
        "pages": [sheet.told for sheet in sheets],
        "order": report,
        "files": _written(files, options, terminal),
        "findings": report["findings"],
    }


def _page(number: int) -> str:
    """Return the name of the file of a manual's page, after the product's name; no drawing of a part has it."""
    return f"manual_{number:02}"


def _drawn(sheets: Iterable[DrawingSheet], terminal: Terminal) -> list[DrawingSheet]:
    """Return sheets, and tell of each when it is drawn."""
    drawn = []
    with terminal.progress("Drawing") as tell:
        for sheet in sheets:
            drawn.append(sheet)
            tell(sheet.name, "done")
    return drawn


def _written(files: Mapping[str, bytes], options: argparse.Namespace, terminal: Terminal) -> list[str]:
    """Write the files of a command, say their paths, and return these."""
    from articad.export.bundle import Bundle

    Bundle(files).write(options.out)
    paths = [str(Path(options.out) / name) for name in files]
    for path in paths:
        terminal.say(path)
    return paths


def _played(target: str, assembly: Any, order: Report) -> str:
    """Return the page of a run, or of anything else, with the order of assembly."""
    from dataclasses import replace

    from articad.report import Documents, report_page
    from articad.runs.record import documents_of
    from articad.runs.run import REQUEST_FILE, Run

    documents = Documents()
    if (Path(target) / REQUEST_FILE).is_file():
        with Run.view(target) as run:
            documents = replace(documents_of(run), exports={}, files=())  # what stands beside the page of the run, not beside this one
    return report_page(assembly, replace(documents, order=order))


def _cut_list(assembly: Any, items: Any, options: argparse.Namespace) -> tuple[Report, str, bytes]:
    """Return the cut list as a report, as text and as a table."""
    from articad.papers.bill import written_csv
    from articad.papers.boards import boards_of, cut_list_json, nested

    boards = boards_of(assembly, items)
    sheets, large = nested(boards, options.sheet, kerf_mm=options.kerf, turn=options.turn)
    report = cut_list_json(boards, sheets, large, kerf_mm=options.kerf)
    lines = [f"Cut list: {sum(board.item.quantity for board in boards)} boards, kerf {options.kerf:g} mm, length along the grain."]
    for board in boards:
        size = f"{board.length_mm:.5g} × {board.width_mm:.5g} × {board.thickness_mm:.5g} mm"
        lines.append(f"  {board.item.quantity} × item {board.item.number} {board.item.name}: {size}, {board.item.material or '-'}")
    for number, sheet in enumerate(sheets, start=1):
        what = f"{sheet.material or '-'}, {sheet.thickness_mm:g} mm, {sheet.size_mm[0]:g} × {sheet.size_mm[1]:g} mm"
        lines.append(f"Sheet {number}: {what}, {100 * sheet.used:.0f} % used")
        for cut in sheet.cuts:
            at = f"{cut.along:.5g} × {cut.across:.5g} mm at ({cut.x:.5g}, {cut.y:.5g})"
            lines.append(f"  item {cut.board.item.number} {cut.board.item.name}: {at}")
    lines += [f"Larger than a sheet: item {board.item.number} {board.item.name}" for board in large]
    header = ("sheet", "material", "thickness_mm", "item", "name", "along_mm", "across_mm", "x_mm", "y_mm")
    rows = [
        (n, sheet.material, sheet.thickness_mm, cut.board.item.number, cut.board.item.name, cut.along, cut.across, cut.x, cut.y)
        for n, sheet in enumerate(sheets, start=1)
        for cut in sheet.cuts
    ]
    unplaced = [
        (None, board.item.material, board.thickness_mm, board.item.number, board.item.name, board.length_mm, board.width_mm, None, None)
        for board in large
        for _ in range(board.item.quantity)
    ]
    return report, "\n".join(lines), written_csv(header, [*rows, *unplaced])


def _kg(mass: float | None) -> str:
    return "-" if mass is None else f"{mass:.4g}"
