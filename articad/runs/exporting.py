"""The exports of a run, written in a process of their own while this one proves the motion."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Self, cast

from articad import formats
from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.kernels.choice import Sandbox
from articad.kernels.kernel import BuildCache
from articad.processes import launcher, scratch
from articad.runs.record import Report, assembly_of, record_export, record_files
from articad.runs.run import Run


class Exports:
    """The exports of an assembly, as far as possible from a process that began to write them before they are wanted.

    The process restores the assembly from the run, and writes into a private folder; only this process changes the run. What it could
    not write is written here, so that a mistake is reported as without it.

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
        self._written: set[str] = set()
        self._process: launcher.Child | None = None
        if beside and names:
            words = [str(run.path.resolve()), str(cache.root.resolve()), sandbox, self._folder.name, *names]
            own = launcher.environment(*launcher.OWN)
            self._process = launcher.start(words, module="articad.runs.exporting", environment=own, stderr=launcher.NOWHERE)

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
        if not self._is_written(name):
            return record_export(self._run, self._assembly, name)
        folder = Path(self._folder.name, name)
        report = json.loads(folder.with_suffix(".json").read_bytes())
        return record_files(self._run, name, {file: (folder / file).read_bytes() for file in report["files"]}, report)

    def _is_written(self, name: str) -> bool:
        """Wait until the process has written a format; return False if it ended before."""
        while name not in self._written:
            line = b"" if self._process is None else self._process.stdout.readline()
            if not line:
                return False
            self._written.add(line.decode().strip())
        return True


def main(words: list[str]) -> int:
    """Write exports of a run: RUN CACHE SANDBOX FOLDER FORMAT…; print the name of each format when its files are complete."""
    path, root, sandbox, place, *names = words
    try:
        assembly = assembly_of(Run.view(path), cache=BuildCache(Path(root)), sandbox=cast("Sandbox", sandbox))
        for name in names:
            bundle = formats.NAMED[name].write(assembly)
            for file, content in bundle.files.items():
                target = Path(place, name, file)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)
            Path(place, f"{name}.json").write_text(json.dumps(bundle.to_json()), encoding="utf-8")
            sys.stdout.write(f"{name}\n")
            sys.stdout.flush()
    except ArticadError:  # the process that asked writes this format itself, and reports it
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
