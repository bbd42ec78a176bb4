"""Trials in processes of their own: this module with `ENGINE FILE ROOT DRIVERS REST OPENED MIMICS` prints measurements as JSON."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from articad.kernels import sandbox
from articad.processes import launcher
from articad.simulation.loading import FILE_SIZE, MEMORY, Engine, answer_in, load, places
from articad.simulation.loading import SECONDS as LOADING_SECONDS
from articad.simulation.verdict import EngineOutcome

SECONDS = 300.0


def try_out(
    engine: Engine,
    path: Path,
    *,
    root: Path | None = None,
    drivers: tuple[str, ...] | None = None,
    rest: Mapping[str, float] | None = None,
    opened: tuple[str, ...] = (),
    mimics: Mapping[str, tuple[str, float, float]] | None = None,
    seconds: float = SECONDS,
) -> EngineOutcome:
    """Load a model in an engine and move it, in a process of its own with limited time and memory.

    Args:
        engine: "mujoco" or "pybullet".
        path: A URDF or MJCF file.
        root: Folder that the engine may read; see `articad.simulation.loading.load`.
        drivers: Joints that drive closed loops; None if they are unknown.
        rest: Rest values of joints by name [rad or m], for files that do not state them.
        opened: Joints that are not driven, because the engine or the file leaves their loop open; "*" for all.
        mimics: Leader, multiplier and offset of joints that follow others in the file; they are driven with their leader.
        seconds: Time after which it is killed; the process that only loads the model gets the usual time if that is more.
    """
    loading = load(engine, path, root=root, seconds=max(seconds, LOADING_SECONDS))
    if not loading.loads:
        return EngineOutcome(engine, loading.version, loads=loading.loads, message=loading.message, late=loading.late)
    words = [
        engine,
        *places(path, root),
        json.dumps(drivers),
        json.dumps(dict(rest or {})),
        json.dumps(opened),
        json.dumps(dict(mimics or {})),
    ]
    limits = launcher.Limits(seconds=seconds, memory=MEMORY, file_size=FILE_SIZE)
    ended = launcher.run(words, module="articad.simulation.trial", limits=limits)
    if ended.late:
        return EngineOutcome(engine, loading.version, loads=None, late=seconds)
    try:
        return EngineOutcome.from_json(answer_in(ended.out))
    except (ValueError, IndexError, TypeError):
        return EngineOutcome(engine, loading.version, loads=False, message=f"its process ended with {ended.how}")


def main(arguments: list[str]) -> int:
    """Simulate a model and print the measurements."""
    engine, path, root, drivers, rest, opened, mimics = arguments
    sandbox.keep_to([root], [str(Path.cwd())])
    names = json.loads(drivers)
    if engine == "mujoco":
        from articad.simulation.mujoco_trial import Trial  # noqa: PLC0415 - each process loads one engine

        trial = Trial.of(Path(path), json.loads(rest), json.loads(mimics))
        outcome = trial.run(None if names is None else tuple(names), frozenset(json.loads(opened)))
    else:
        from articad.simulation.bullet_trial import run  # noqa: PLC0415

        outcome = run(Path(path), json.loads(rest), json.loads(mimics), frozenset(json.loads(opened)))
    print("\n" + json.dumps(asdict(outcome)))  # noqa: T201 - this is the answer; PyBullet may have left a line open
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
