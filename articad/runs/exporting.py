"""The exports of a run, written in a process of their own while this one proves the motion."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Final, Self, cast

from articad import formats
from articad.assembly import Assembly
from articad.kernels.choice import Sandbox
from articad.kernels.kernel import BuildCache
from articad.processes import launcher, scratch
from articad.runs.record import Report, assembly_of, record_export, record_files
from articad.runs.run import Run

_SECONDS: Final = 600.0  # of waiting for one format; FreeCAD needs 5 s for each part
_LIMITS: Final = launcher.Limits(processor=7200, memory=8 << 30, file_size=1 << 30)  # FreeCAD inherits them, and is allowed less
_LOOK_S: Final = 0.01
_OUTPUT: Final = "output"  # no format has this name
_SAID: Final = 2000  # bytes of its output that the trace keeps, the last ones


class Exports:
    """The exports of an assembly, as far as possible from a process that began to write them before they are wanted.

    The process restores the assembly from the run, and writes into a private folder; only this process changes the run. What it could
    not write in time is written here, so that a mistake is reported as without it. The trace then says how it ended.

    Args:
        run: A run with its assembly, open for writing.
        assembly: The assembly.
        names: Formats, in the order in which they are wanted.
        beside: Whether to start the process: it pays where something else is to be done in the meantime.
        cache: Where the parts are kept.
        sandbox: Isolation of part scripts, for parts that are not in the cache.
    """

    def __init__(
        self, run: Run, assembly: Assembly, names: Sequence[str], *, beside: bool, cache: BuildCache, sandbox: Sandbox = "strict"
    ) -> None:
        self._run, self._assembly = run, assembly
        self._folder = scratch.folder("exports")
        self._process: launcher.Child | None = None
        if beside and names:
            words = [str(run.path.resolve()), str(cache.root.resolve()), sandbox, self._folder.name, *names]
            own = launcher.environment(*launcher.OWN)
            try:
                with Path(self._folder.name, _OUTPUT).open("wb") as output:
                    self._process = launcher.start(
                        words,
                        module="articad.runs.exporting",
                        limits=_LIMITS,
                        environment=own,
                        stdout=output.fileno(),
                        stderr=launcher.TO_STDOUT,
                    )
            except OSError as error:  # too many processes, or too little memory for one
                self._tell(f"did not start: {error}")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._process is not None:
            self._process.close()
        self._folder.cleanup()

    def record(self, name: str) -> Report:
        """Save an export in the run; return its report `articad.losses/1`, with the folder.

        Raises:
            ExportError: If the assembly cannot be written in this format.
        """
        folder = Path(self._folder.name, name)
        written = folder.with_suffix(".json")
        if not self._is_written(written):
            return record_export(self._run, self._assembly, name)
        report = json.loads(written.read_bytes())
        return record_files(self._run, name, {file: (folder / file).read_bytes() for file in report["files"]}, report)

    def _is_written(self, report: Path) -> bool:
        """Wait until the process has written a format; return False if it ended before, or is ended because it takes too long."""
        until = time.monotonic() + _SECONDS
        while not report.exists():  # it appears complete, after all other files
            if self._process is None:
                return False
            if self._process.wait(_LOOK_S):
                self._end(self._process, report.stem, late=False)
            elif time.monotonic() > until:
                self._end(self._process, report.stem, late=True)
        return True

    def _end(self, process: launcher.Child, name: str, *, late: bool) -> None:
        """End the process, and keep in the trace what it said last."""
        self._process, code = None, process.close()
        with Path(self._folder.name, _OUTPUT).open("rb") as output:
            output.seek(max(0, output.seek(0, os.SEEK_END) - _SAID))
            ended = launcher.Ended(code, late, output.read(), b"")
        how = f"was ended, because {name} took longer than {_SECONDS:g} s" if late else f"ended before {name}, with {ended.how}"
        self._tell(f"{how}: {ended.out.decode(errors='replace').strip() or 'it said nothing'}")

    def _tell(self, what: str) -> None:
        self._run.trace("note", where="export", message=f"the process that writes exports {what}")


def main(words: list[str]) -> None:
    """Write exports of a run: RUN CACHE SANDBOX FOLDER FORMAT…; the report of each format appears when its files are complete."""
    path, root, sandbox, place, *names = words
    assembly = assembly_of(Run.view(path), cache=BuildCache(Path(root)), sandbox=cast("Sandbox", sandbox))
    for name in names:
        bundle = formats.NAMED[name].write(assembly)
        for file, content in bundle.files.items():
            target = Path(place, name, file)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        scratch.write(Path(place, f"{name}.json"), json.dumps(bundle.to_json()).encode())


if __name__ == "__main__":
    main(sys.argv[1:])
