"""The parts list: each part once, masses that add up to the product's, and the same numbers in every format."""

from __future__ import annotations

import csv
import io
import zipfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.kinematics import declare
from articad.papers.bill import COLUMNS, bill_json, bill_xlsx, rows_of, written_csv
from articad.papers.boards import Board, Cut, boards_of, nested
from articad.papers.items import items_of
from tests.assemblies import block, frame

ORIGIN = frame()


def shelf() -> Assembly:
    """A side board that carries three shelves, two of them equal, and a peg."""
    side = block("side", (400, 18, 900), **dict.fromkeys("abcd", ORIGIN))
    shelves = [
        block("low", (380, 300, 18), root=ORIGIN),
        block("middle", (18, 300, 380), root=ORIGIN),
        block("top", (390, 300, 18), root=ORIGIN),
    ]
    peg = block("=peg", (8, 8, 30), root=ORIGIN)
    parts = [side, *(replace(part, material="birch") for part in shelves), replace(peg, material="steel")]
    joints = [declare.fixed(part.name.strip("="), side[key], part["root"]) for key, part in zip("abcd", parts[1:], strict=True)]
    return Assembly.from_parts("shelf", parts=parts, joints=joints, ground="side", T_ground=SE3.identity())


def test_each_part_is_counted_once_and_the_masses_add_up() -> None:
    assembly = shelf()
    items = items_of(assembly)
    assert [item.parts for item in items] == [("side",), ("low", "middle"), ("top",), ("=peg",)]
    assert sorted(name for item in items for name in item.parts) == sorted(assembly.parts)
    total = assembly.mass().mass
    report = bill_json(assembly, items)
    assert report["mass_kg"] == pytest.approx(total, rel=1e-12)
    assert sum(row["total_kg"] for row in report["items"]) == pytest.approx(total, rel=1e-12)
    assert [row["item"] for row in report["items"]] == [1, 2, 3, 4]


def test_one_shape_of_two_materials_is_two_items() -> None:
    assembly = shelf()
    parts = {name: replace(part, material="oak") if name == "low" else part for name, part in assembly.parts.items()}
    assert [item.parts for item in items_of(replace(assembly, parts=parts))] == [("side",), ("low",), ("middle",), ("top",), ("=peg",)]


def test_bought_parts_are_named_by_the_user_and_a_name_of_no_part_is_refused() -> None:
    assert [item.supply for item in items_of(shelf(), ["*peg"])] == ["made", "made", "made", "purchased"]
    with pytest.raises(ArticadError, match="no part has this name"):
        items_of(shelf(), ["lo"])


def test_two_parts_that_a_joint_says_are_bought_as_one_are_bought() -> None:
    assembly = shelf()
    joints = [replace(joint, fastening="purchased") if joint.name == "peg" else joint for joint in assembly.mechanism.joints]
    bought = Assembly.from_parts("shelf", parts=[*assembly.parts.values()], joints=joints, ground="side", T_ground=SE3.identity())
    assert {item.name for item in items_of(bought) if item.supply == "purchased"} == {"side", "=peg"}
    assert {item.name for item in items_of(bought, ["top"]) if item.supply == "purchased"} == {"side", "top", "=peg"}


def read_xlsx(content: bytes) -> tuple[dict[str, Any], list[str | None]]:
    """Return the values of a workbook's first sheet by their places, and its formulas."""
    with zipfile.ZipFile(io.BytesIO(content)) as book:
        sheet = etree.fromstring(book.read("xl/worksheets/sheet1.xml"))
        strings = ["".join(entry.itertext()) for entry in etree.fromstring(book.read("xl/sharedStrings.xml"))]
    space = {"s": "http://schemas.openxmlformats.org/spreadsheetml/2006/main"}
    found = [(cell, value) for cell in sheet.iterfind(".//s:c", space) if (value := cell.findtext("s:v", namespaces=space)) is not None]
    values = {cell.get("r"): strings[int(value)] if cell.get("t") == "s" else float(value) for cell, value in found}
    return values, [cell.text for cell in sheet.iterfind(".//s:f", space)]


def test_csv_and_xlsx_hold_the_same_cells_and_compute_nothing_that_a_name_says() -> None:
    pytest.importorskip("xlsxwriter")
    assembly = shelf()
    items = items_of(assembly)
    table = list(csv.reader(io.StringIO(written_csv(COLUMNS, rows_of(items)).decode())))
    assert table[0] == list(COLUMNS)
    assert [row[1] for row in table[1:]] == ["side", "low", "top", "'=peg"]

    content = bill_xlsx(assembly, items)
    assert content == bill_xlsx(assembly, items)
    values, formulas = read_xlsx(content)
    assert formulas == ["SUM(C2:C5)", "SUM(F2:F5)"]
    assert values["B5"] == "=peg"
    assert values["F6"] == pytest.approx(assembly.mass().mass)
    assert [values[f"C{row}"] for row in range(2, 6)] == [float(row[2]) for row in table[1:]]


def test_a_text_that_is_too_long_for_a_cell_says_so() -> None:
    """A workbook's cell holds 32,767 UTF-16 units; a writer drops what is longer, and then the whole cell is empty."""
    pytest.importorskip("xlsxwriter")
    assembly = shelf()
    (first, second, *others) = items_of(assembly)
    many = tuple(f"peg_{number}" for number in range(8000))
    long = [replace(first, parts=many), replace(second, description="\U0001f642" * 20_000), *others]
    values, _ = read_xlsx(bill_xlsx(assembly, long))
    cell, described = values["M2"], values["K3"]
    kept, _, told = cell.partition(" … ")
    assert kept.split() == list(many[: len(kept.split())])
    assert told == f"({len(' '.join(many)) - len(kept)} more characters, which CSV and JSON hold)"
    assert described.startswith("\U0001f642" * 16_000)
    assert all(32_600 < len(text.encode("utf-16-le")) / 2 <= 32_767 for text in (cell, described))


def is_cut_from_edge_to_edge(cuts: Sequence[Cut]) -> bool:
    """Whether straight cuts, each from edge to edge of what is left, separate all blanks."""
    if len(cuts) < 2:
        return True
    for ends in ([(cut.x, cut.x + cut.along) for cut in cuts], [(cut.y, cut.y + cut.across) for cut in cuts]):
        for place in sorted({high for _, high in ends}):
            before = [cut for cut, (_, high) in zip(cuts, ends, strict=True) if high <= place + 1e-9]
            after = [cut for cut, (low, _) in zip(cuts, ends, strict=True) if low >= place - 1e-9]
            if before and after and len(before) + len(after) == len(cuts):
                return is_cut_from_edge_to_edge(before) and is_cut_from_edge_to_edge(after)
    return False


def test_boards_lie_on_sheets_without_overlap_one_kerf_apart_and_along_the_grain() -> None:
    assembly = shelf()
    boards = boards_of(assembly, items_of(assembly))
    assert [(board.item.name, board.length_mm, board.width_mm, board.thickness_mm) for board in boards] == [
        ("side", 900, 400, 18), ("low", 380, 300, 18), ("top", 390, 300, 18),
    ]  # fmt: skip
    many = [Board(replace(board.item, parts=board.item.parts * 5), *(board.length_mm, board.width_mm, 18.0)) for board in boards]
    sheets, large = nested(many, (1000.0, 850.0), kerf_mm=4.0)
    assert not large
    assert sum(len(sheet.cuts) for sheet in sheets) == sum(board.item.quantity for board in many)
    for sheet in sheets:
        for index, cut in enumerate(sheet.cuts):
            assert (cut.along, cut.across) == pytest.approx((cut.board.length_mm, cut.board.width_mm))
            assert min(cut.x, cut.y) >= 0
            assert cut.x + cut.along <= 1000 + 1e-9
            assert cut.y + cut.across <= 850 + 1e-9
            for other in sheet.cuts[:index]:
                gaps = (
                    max(cut.x - other.x - other.along, other.x - cut.x - cut.along),
                    max(cut.y - other.y - other.across, other.y - cut.y - cut.across),
                )
                assert max(gaps) >= 4.0 - 1e-9
        assert is_cut_from_edge_to_edge(sheet.cuts)
    assert [board.item.name for board in nested(boards, (850.0, 500.0), kerf_mm=4.0)[1]] == ["side"]
    assert not nested(boards, (410.0, 910.0), kerf_mm=4.0, turn=True)[1]


def test_a_block_a_clip_and_a_cylinder_are_no_boards(tmp_path: Path) -> None:
    for size in ((50, 60, 40), (26, 26, 4)):
        blocks = Assembly.from_parts("one", parts=[block("cube", size)], joints=[], ground="cube")
        assert boards_of(blocks, items_of(blocks)) == (), size
