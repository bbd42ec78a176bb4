"""A run of the benchmark of planted faults: its cases, and the files of its results."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self

from articad.processes import scratch
from articad_bench.fault_table import page, report, rows_of
from articad_bench.fault_trial import Row, Tools, examined, programs, tried
from articad_bench.faulty import PRODUCTS, Fault, Product, chosen
from articad_bench.plan_faults import PLAN_KINDS
from articad_bench.script_faults import SCRIPT_KINDS
from articad_bench.task import read_json

__all__ = ["KINDS", "FaultRun"]

KINDS: Final = (*PLAN_KINDS, *SCRIPT_KINDS)
_EACH: Final = 7  # cases of a kind, each in another product
_RESULTS, _PAGE = "faults.json", "faults.md"
Again = Callable[[Row], bool]
"""Returns whether a case that has a result is tried again."""


@dataclass(frozen=True)
class FaultRun:
    """The cases that are tried, and the good products that must cause no finding.

    Attributes:
        faults: The cases, by kind.
        products: The good products.
    """

    faults: Sequence[Fault]
    products: Sequence[Product]

    @classmethod
    def of(cls, names: Sequence[str] = (), some: int | None = None) -> Self:
        """Return the cases of the benchmark.

        Args:
            names: Products; all by default.
            some: How many cases, spread evenly over all kinds; all by default. The good products are then not tried.

        Raises:
            ReadError: If there is no product of a name.
        """
        products = [Product.named(name) for name in names or PRODUCTS]
        faults = list(chosen(KINDS, products, _EACH))
        if some is None or some >= len(faults):
            return cls(faults, products)
        return cls([faults[place * len(faults) // some] for place in range(some)], ())

    def work(
        self,
        out: Path,
        tools: Tools,
        *,
        again: Again = lambda _row: False,
        repair: bool = False,
        tell: Callable[[str, str], object] = lambda _case, _outcome: None,
    ) -> dict[str, Any]:
        """Try all cases, write `faults.json` and the page `faults.md`, and return the report.

        The results are written after every case, and a case whose plan and scripts are unchanged is not tried again. Nor are good
        products that the present programs have examined.

        Args:
            out: Folder of both files.
            tools: What parts are built with.
            again: Returns whether to try a case again that has a result.
            repair: Whether to follow the hints of each case that is tried.
            tell: Called with each case and its outcome.
        """
        out.mkdir(parents=True, exist_ok=True)
        stored = read_json(out / _RESULTS) if (out / _RESULTS).is_file() else {}
        rows, alarms = _known(stored), dict(stored.get("alarms", {}))
        for fault in self.faults:
            row = rows.get(fault.digest)
            if row is None or row.case != fault.name or again(row):
                row = rows[fault.digest] = tried(fault, tools, repair=repair)
                self._save(out, rows, alarms, stored.get("examined_by", ""))
            tell(fault.name, "same" if row.equivalent else "valid" if row.valid else "escaped" if row.escaped else row.stage)
        examined_by = stored.get("examined_by", "")
        if self.products and (examined_by != programs() or not {product.name for product in self.products} <= set(alarms)):
            alarms = {product.name: [str(one) for one in examined(product, tools).findings] for product in self.products}
            examined_by = programs()
        return self._save(out, rows, alarms, examined_by)

    def _save(self, out: Path, rows: Mapping[str, Row], alarms: Mapping[str, Sequence[str]], examined_by: str) -> dict[str, Any]:
        tried_ones = [rows[fault.digest] for fault in self.faults if fault.digest in rows]
        told = report(tried_ones, alarms, planned=len(self.faults), examined_by=examined_by, judged_by=programs())
        for name, text in ((_RESULTS, json.dumps(told, indent=1) + "\n"), (_PAGE, page(told, KINDS))):
            scratch.write(out / name, text.encode())  # a run that is killed leaves whole files
        return told


def _known(stored: Mapping[str, Any]) -> dict[str, Row]:
    """Return earlier results by digest, except defects: those are tried again."""
    rows = rows_of(stored) if stored else []
    return {row.digest: row for row in rows if row.stage != "defect"}
