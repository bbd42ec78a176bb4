"""Items of a batch: one assembly each, from a plan with values for its parameters to checked exports in a folder of its own.

An item is identified by its digest: plan, scripts, values, gates, formats and version. Its folder appears complete or not at all, so
any number of processes may work on the same batch, a killed one leaves nothing incomplete, and a rerun makes nothing twice.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from articad import __version__
from articad.aliases import Json
from articad.assembly import Assembly
from articad.batches.specification import Gate, ItemRow, first_fault
from articad.errors import ArticadError, ReadError
from articad.files import PLAN_BYTES, RECORD_BYTES, SCRIPT_BYTES, read_file
from articad.findings import Findings
from articad.formats import NAMED
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import PartKernel
from articad.plan.schema import AssemblyPlan
from articad.processes import scratch
from articad.runs.forms import FINDING, misfit
from articad.runs.run import digest

SCHEMA: Final = "articad.item/1"
_KEPT: Final = {"schema": frozenset({SCHEMA}), "digest": str, "ok": bool, "findings": [FINDING], "files?": {str: str}, "error?": str}
ITEM: Final = "item.json"
STEPS: Final = 24  # poses of each driver for the gate "motion"
BUDGET_S: Final = 60.0  # for the gate "certified"


@dataclass(frozen=True)
class BatchItem:
    """One assembly to make.

    Attributes:
        plan: Folder with `plan.json` and `parts/`.
        values: Values of parameters in their own units; other parameters keep the plan's values.
        gates: Checks it must pass to be exported: "rest", "motion" (sampled), "certified".
        formats: Formats to write.
        kernel: Builds the scripts; the plan's own by default.
    """

    plan: str
    values: Mapping[str, float] = field(default_factory=dict)
    gates: tuple[Gate, ...] = ("rest",)
    formats: tuple[str, ...] = ("urdf", "mjcf")
    kernel: str | None = None

    @cached_property
    def digest(self) -> str:
        """The digest that identifies the item."""
        folder = Path(self.plan)
        try:
            found = sorted((folder / "parts").glob("*.py"))
            scripts = {file.name: read_file(file, SCRIPT_BYTES, root=folder).decode() for file in found}
            text = read_file(folder / "plan.json", PLAN_BYTES, root=folder).decode()
        except (OSError, UnicodeDecodeError) as error:
            raise _refused(folder, f"It cannot be read: {error}.") from error
        key = {"plan": text, "scripts": scripts, "values": dict(sorted(self.values.items())), "gates": list(self.gates)}
        return digest(key | {"formats": list(self.formats), "kernel": self.kernel, "articad": __version__})

    def to_json(self) -> Json:
        """Return the item as JSON for other processes."""
        return {
            "plan": self.plan,
            "values": dict(self.values),
            "gates": list(self.gates),
            "formats": list(self.formats),
            "kernel": self.kernel,
        }

    @classmethod
    def from_json(cls, stored: Mapping[str, Any]) -> BatchItem:
        """Read an item.

        Raises:
            ReadError: If it does not have the form; the message says what is wrong.
        """
        try:
            return cls.of(ItemRow.model_validate(stored))
        except ValidationError as error:
            raise _refused(
                Path("items"), f"An item needs `plan`, and may have `values`, `gates`, `formats`, `kernel`: {first_fault(error)}."
            ) from error

    @classmethod
    def of(cls, row: ItemRow) -> BatchItem:
        """Return the item of a row."""
        return cls(row.plan, row.values, row.gates, row.formats, row.kernel)


def make(item: BatchItem, out: str | Path) -> Json:
    """Make one item, unless it is already there with all its files as they were written; what is there otherwise is replaced.

    Args:
        item: What to make.
        out: Folder of the batch; the item's own is `<first two of its digest>/<digest>`.

    Returns:
        Its record `articad.item/1`: provenance, whether it passed, findings, files with the sha256 of each, how long each stage took,
        and `made`, which is "now" or "before".
    """
    folder = Path(out) / item.digest[:2] / item.digest
    if (kept := _kept(folder, item.digest)) is not None:
        return {**kept, "made": "before"}
    with contextlib.ExitStack() as stack:
        if folder.exists():
            stack.enter_context(scratch.set_aside(folder))()
        empty = stack.enter_context(scratch.folder_beside(folder))
        record = _made(item, empty)
        (empty / ITEM).write_text(json.dumps(record, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")
    return {**record, "made": "now"}


def _kept(folder: Path, digest: str) -> Json | None:
    """Return the record of an item that is there; None if it is not, or if one of its files is not what was written."""
    try:
        record = json.loads(read_file(folder / ITEM, PLAN_BYTES, root=folder))
        if misfit(record, _KEPT) or record["digest"] != digest:
            return None
        files: Mapping[str, str] = record.get("files", {})
        whole = all(hashlib.sha256(read_file(folder / name, RECORD_BYTES, root=folder)).hexdigest() == sha for name, sha in files.items())
    except (OSError, ValueError, RecursionError):
        return None
    return dict(record) if whole else None


def make_stored(item: Json, out: str) -> Json:
    """Make an item given as JSON from another process."""
    return make(BatchItem.from_json(item), out)


def _made(item: BatchItem, folder: Path) -> Json:
    clock = _Clock()
    record: Json = {"schema": SCHEMA, "digest": item.digest, "articad": __version__, **item.to_json()}
    built: dict[str, int] = {}
    try:
        with clock.on("plan"):
            plan = AssemblyPlan.load(item.plan)
        with clock.on("kernel"):
            kernel = _kernel(item.kernel or plan.kernel)
            assembly = Assembly.from_plan(plan, Path(item.plan) / "parts", kernel=kernel, jobs=1, parameters=item.values)
        record |= {"kernel": kernel.name, "kernel_version": kernel.version}
        sources = [part for part in assembly.realised.values() if part.derived_from is None]
        built = {"parts_built": sum(not part.cached for part in sources), "parts_kept": sum(part.cached for part in sources)}
        with clock.on("checks"):
            findings = _gated(item, assembly)
        if findings.ok:
            with clock.on("exports"):
                written = [path for name in item.formats for path in NAMED[name].write(assembly).write(folder / name)]
            files = {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in written}
            record |= {"files": files, "mass_kg": assembly.mass().mass, "freedoms": assembly.mechanism.mobility}
        record |= {"ok": findings.ok, "findings": [finding.to_json() for finding in findings]}
    except ArticadError as error:
        record |= {"ok": False, "error": str(error), "findings": [finding.to_json() for finding in error.findings]}
    return record | built | {"seconds": {name: round(spent, 4) for name, spent in clock.spent.items()}}


def _gated(item: BatchItem, assembly: Assembly) -> Findings:
    found = assembly.check().findings
    if found.ok and "motion" in item.gates:
        found += assembly.check_motion(steps=STEPS).findings
    if found.ok and "certified" in item.gates:
        found += assembly.certify(budget=BUDGET_S).findings
    return found


@cache
def _kernel(name: str) -> PartKernel:
    """Return the kernel; one per process, because its start takes as long as ten parts."""
    return kernel_named(name)


class _Clock:
    """Seconds by stage."""

    def __init__(self) -> None:
        self.spent: dict[str, float] = {}

    @contextlib.contextmanager
    def on(self, stage: str) -> Iterator[None]:
        start = time.perf_counter()
        try:
            yield
        finally:
            self.spent[stage] = self.spent.get(stage, 0.0) + time.perf_counter() - start


def _refused(path: Path, message: str) -> ReadError:
    return ReadError.at(path, message, "Correct the batch's specification.", said=message)
