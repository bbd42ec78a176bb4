"""Trials in processes of their own: this module with `ENGINE FILE DRIVERS` prints what an engine measured as JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path

from articad.kernels import sandbox
from articad.processes import launcher
from articad.simulation.loading import FILE_SIZE, MEMORY, Engine, answer_in, load, places
from articad.simulation.verdict import Outcome

SECONDS = 300.0


def try_out(
    engine: Engine, path: Path, *, root: Path | None = None, drivers: tuple[str, ...] | None = None, seconds: float = SECONDS
) -> Outcome:
    """Have an engine load a model and move it, in a process of its own with bounded time and memory.

    Args:
        engine: "mujoco" or "pybullet".
        path: A URDF or MJCF file.
        root: Folder that the engine may read; see `articad.simulation.loading.load`.
        drivers: Joints that drive closed loops; None where nobody knows.
        seconds: After which it is ended.
    """
    loading = load(engine, path, root=root)
    if not loading.loads:
        return Outcome(engine, loading.version, loads=loading.loads, message=loading.message)
    words = [engine, *places(path, root), json.dumps(drivers)]
    limits = launcher.Limits(seconds=seconds, memory=MEMORY, file_size=FILE_SIZE)
    ended = launcher.run(words, module="articad.simulation.trial", limits=limits)
    if ended.late:
        return Outcome(engine, loading.version, loads=False, message=f"it was not done after {seconds:g} s")
    try:
        return Outcome.from_json(answer_in(ended.out))
    except (ValueError, IndexError, TypeError):
        return Outcome(engine, loading.version, loads=False, message=f"its process ended with {ended.how}")


def main(arguments: list[str]) -> int:
    """Try a model out and print what was measured."""
    engine, path, root, drivers = arguments
    sandbox.keep_to([root], [str(Path.cwd())])
    names = json.loads(drivers)
    if engine == "mujoco":
        from articad.simulation.mujoco_trial import Trial  # noqa: PLC0415 - each process loads one engine

        outcome = Trial.of(Path(path)).run(None if names is None else tuple(names))
    else:
        from articad.simulation.bullet_trial import run  # noqa: PLC0415

        outcome = run(Path(path))
    print("\n" + json.dumps(asdict(outcome)))  # noqa: T201 - this is the answer; PyBullet may have left a line open
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
