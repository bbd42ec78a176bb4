"""A script may report any trace: it makes no tree then, and the export goes on."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad.kernels.cache import BuildCache
from articad.kernels.kernel import BuiltPart
from articad.kernels.results import read_lines
from articad.kernels.sandbox import ScriptLimits
from articad.kernels.trees import part_tree

AXES = {"o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}
BRIEF: dict[str, Any] = {
    "name": "post",
    "dimensions": {"height": 10.0},
    "connectors": {"foot": {**AXES, "label": "", "joints": []}},
}
BOX = {"kind": "box", "line": 1, "numbers": [1, 2, [0]], "operands": [], "at": [0, 0, 0], "turn": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}
TRACE: dict[str, Any] = {"ok": True, "rows": [BOX], "formulas": [["d height"]], "connectors": {"foot": AXES}}
MEASURE: dict[str, Any] = {
    "ok": True, "choice": 0, "faces": 6, "volume_mm3": 20.0, "area_mm2": 64.0, "com_mm": [0, 0, 0],
    "inertia_mm5": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
}  # fmt: skip
NESTED = json.loads("[" * 900 + "]" * 900)
FORGED: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "a choice that was not offered": (TRACE, MEASURE | {"choice": 3}),
    "an endless choice": (TRACE, MEASURE | {"choice": 10**30}),
    "a choice before the first": (TRACE, MEASURE | {"choice": -1}),
    "a negative area": (TRACE, MEASURE | {"area_mm2": -64.0}),
    "no volume": (TRACE, MEASURE | {"volume_mm3": 0}),
    "an endless area": (TRACE, MEASURE | {"area_mm2": 10**400}),
    "an endless moment": (TRACE, MEASURE | {"inertia_mm5": [[10**400] * 3] * 3}),
    "measures in lists": (TRACE, MEASURE | {"com_mm": NESTED}),
    "an endless number": (TRACE | {"rows": [BOX | {"numbers": [1, 2, 10**400]}]}, MEASURE),
    "an endless place": (TRACE | {"rows": [BOX | {"at": [10**400, 0, 0]}]}, MEASURE),
    "an endless rotation": (TRACE | {"rows": [BOX | {"turn": [[10**400, 0, 0], [0, 1, 0], [0, 0, 1]]}]}, MEASURE),
    "an operation in lists": (TRACE | {"rows": [BOX | {"kind": NESTED}]}, MEASURE),
    "numbers in lists": (TRACE | {"rows": [BOX | {"numbers": NESTED}]}, MEASURE),
    "an operand that comes later": (TRACE | {"rows": [BOX | {"kind": "fuse", "numbers": [], "operands": [0, 1]}]}, MEASURE),
    "a formula of itself": (TRACE | {"formulas": [["neg", [0]]]}, MEASURE),
    "code for a formula": (TRACE | {"formulas": [["__import__", 1]]}, MEASURE),
    "a dimension of another object": (TRACE | {"formulas": [["d height) + Other.d_x"]]}, MEASURE),
    "an endless operand": (TRACE | {"formulas": [["neg", 10**400]]}, MEASURE),
    "no connectors": ({key: value for key, value in TRACE.items() if key != "connectors"}, MEASURE),
    "a connector in lists": (TRACE | {"connectors": {"foot": NESTED}}, MEASURE),
    "an endless connector": (TRACE | {"connectors": {"foot": {"o": [10**400, 0, 0], "z": [0, 0, 1]}}}, MEASURE),
    "a reason in lists": ({"ok": False, "reason": NESTED}, MEASURE),
    "a reason of another terminal": ({"ok": False, "reason": "\x1b]0;x\x07" * 1000}, MEASURE),
}


class Forger:
    """A kernel whose script leaves what it likes."""

    version = "1"
    limits = ScriptLimits()

    def __init__(self, folder: Path, trace: dict[str, Any], measure: dict[str, Any]) -> None:
        self.report = folder / "report"
        self.trace, self.measure = trace, measure

    def run_task(self, task: str, request: dict[str, Any], _: object) -> list[dict[str, Any]]:
        """Return lines that went through a report, as those of a script do."""
        assert task == "trace"
        lines = [self.trace, *[self.measure] * len(request["variations"])]
        self.report.write_text("".join(json.dumps(line) + "\n" for line in lines))
        return read_lines(self.report)


class NoFreeCAD:
    """Nothing that was forged comes so far."""

    version_text = "1"


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_trace_makes_no_tree(name: str, tmp_path: Path) -> None:
    built = BuiltPart.__new__(BuiltPart)
    object.__setattr__(built, "brief", BRIEF)
    kernel: Any = Forger(tmp_path, *FORGED[name])
    freecad: Any = NoFreeCAD()
    tree = part_tree(None, built, b"x = 1\n", kernel=kernel, freecad=freecad, cache=BuildCache(tmp_path / "cache"))  # type: ignore[arg-type]
    assert tree.document is None
    assert tree.reason
    assert tree.reason.isprintable()
    assert len(tree.reason) < 400
