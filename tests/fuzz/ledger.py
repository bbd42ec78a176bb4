"""The ledger of fuzzing: how much processor time each reader had since its own sources last changed.

A reader's own sources are the modules of articad that run while it reads its corpus, without the core that every assembly needs. Their
digest ignores comments, docstrings and layout. So minutes add up over days, and a change of a reader resets its own row alone.
"""

from __future__ import annotations

import ast
import fcntl
import hashlib
import json
import sys
import threading
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

import articad
from tests.fuzz.readers import attempt, seeds

FILE: Final = Path(__file__).with_name("ledger.json")
_PACKAGE: Final = Path(articad.__file__).parent
_CORE: Final = ("assembly.py", "connectors/", "errors.py", "findings/", "geometry/", "kinematics/", "processes/")
"""Modules of every assembly; random mechanisms test them. A change there resets nothing."""
_READ_THERE: Final = {
    "stl": ("geometry/mesh_files.py",),
    "obj": ("geometry/mesh_files.py",),
    "glb": ("geometry/mesh_files.py",),
    "ply": ("geometry/mesh_files.py",),
    "dae": ("geometry/mesh_files.py",),
}
"""Modules within the core that are a reader's own."""


def sources(name: str) -> tuple[str, ...]:
    """Return the modules of articad that a reader runs on its corpus, without the core; as paths below the package."""
    ran: set[str] = set()

    def see(frame: Any, event: str, _: Any) -> None:
        if event == "call":
            ran.add(frame.f_code.co_filename)

    before = sys.getprofile()
    threading.setprofile(see)
    sys.setprofile(see)
    try:
        for content in seeds(name):
            attempt(name, content)
    finally:
        sys.setprofile(before)
        threading.setprofile(None)
    modules = {path.relative_to(_PACKAGE).as_posix() for file in ran if (path := Path(file)).is_relative_to(_PACKAGE)}
    return tuple(sorted({module for module in modules if not module.startswith(_CORE)} | set(_READ_THERE.get(name, ()))))


def digest(modules: Iterable[str], package: Path = _PACKAGE) -> str:
    """Return a digest of what modules do: comments, docstrings and layout do not count."""
    total = hashlib.sha256()
    for module in modules:
        tree = ast.parse((package / module).read_bytes())
        for node in ast.walk(tree):
            body = getattr(node, "body", None)
            if isinstance(body, list) and body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
                del body[0]
        total.update(f"{module}\n{ast.dump(tree)}\n".encode())
    return total.hexdigest()[:16]


class Ledger:
    """A file with a row for each reader; several processes may add to it.

    Args:
        file: The file; it need not be there.
        digests: The digest of each reader's own sources now.
    """

    def __init__(self, file: Path, digests: Mapping[str, str]) -> None:
        self._file, self._digests = file, digests

    def row(self, name: str) -> dict[str, Any]:
        """Return the row of a reader: `processor_s`, `inputs`, `coverage` and `found` since its sources changed."""
        return self._row(self._rows(), name)

    def seconds(self, name: str) -> float:
        """Return the processor time that the present sources of a reader have had [s]."""
        return float(self.row(name)["processor_s"])

    def add(self, name: str, *, processor_s: float, inputs: int, coverage: int, found: int) -> None:
        """Add a turn of a reader."""
        self._file.touch()
        with self._file.open("r+") as stream:
            fcntl.flock(stream, fcntl.LOCK_EX)
            rows = self._rows()
            row = self._row(rows, name)
            row["processor_s"] = round(row["processor_s"] + processor_s, 1)
            row["inputs"] += inputs
            row["coverage"] = max(row["coverage"], coverage)
            row["found"] += found
            rows[name] = row
            text = ",\n".join(f" {json.dumps(key)}: {json.dumps(rows[key])}" for key in sorted(rows))
            stream.seek(0)
            stream.truncate()
            stream.write(f"{{\n{text}\n}}\n")

    def _rows(self) -> dict[str, Any]:
        text = self._file.read_text() if self._file.exists() else ""
        return dict(json.loads(text)) if text else {}

    def _row(self, rows: Mapping[str, Any], name: str) -> dict[str, Any]:
        row = rows.get(name, {})
        if row.get("sources") == self._digests[name]:
            return dict(row)
        return {"sources": self._digests[name], "processor_s": 0.0, "inputs": 0, "coverage": 0, "found": 0}
