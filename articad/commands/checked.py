"""The check of a watched product at rest, in a process of its own: it is ended when the next edit comes."""

from __future__ import annotations

import argparse
import json
import sys
import threading
from pathlib import Path
from typing import Any, Final

from articad.processes import launcher

_SECONDS: Final = 1800.0
_ASKED: Final = ("kernel", "sandbox", "jobs", "parameters")  # options of the watch that decide what is built


class Check:
    """A check that is running, or has ended.

    Args:
        folder: Holds the plan and the part scripts; the parts are in the cache already.
        options: Of the watch.
    """

    def __init__(self, folder: Path, options: argparse.Namespace) -> None:
        order = {"folder": str(folder.resolve()), **{name: getattr(options, name) for name in _ASKED}}
        self._child = launcher.start(
            [json.dumps(order)],
            module="articad.commands.checked",
            limits=launcher.Limits(seconds=_SECONDS),
            environment=launcher.environment(*launcher.OWN),
        )
        self._ended: launcher.Ended | None = None
        self._thread = threading.Thread(target=self._wait, daemon=True)
        self._thread.start()

    def _wait(self) -> None:
        self._ended = self._child.finish()

    @property
    def has_ended(self) -> bool:
        """Whether it has ended, by itself or by `stop`."""
        return not self._thread.is_alive()

    def stop(self) -> None:
        """End it."""
        self._child.kill()
        self._thread.join()

    def report(self) -> dict[str, Any] | None:
        """Return the report of the checks; None if it was ended or failed."""
        if self._ended is None or self._ended.code:
            return None
        return dict(json.loads(self._ended.out))

    @property
    def failure(self) -> str:
        """How it ended without a report."""
        if self._ended is None:
            return "it did not start"
        return "it took too long" if self._ended.late else self._ended.last_line


def main(order: str) -> None:
    """Print the report of the checks of a product at rest."""
    from articad.commands.steps import assembled
    from articad.commands.terminal import Terminal
    from articad.plan.schema import AssemblyPlan

    told = json.loads(order)
    folder = Path(told.pop("folder"))
    options = argparse.Namespace(**told, force=False)
    assembly = assembled(AssemblyPlan.load(folder), folder / "parts", options, Terminal(as_json=True))
    json.dump(assembly.check().to_json(), sys.stdout)


if __name__ == "__main__":
    main(sys.argv[1])
