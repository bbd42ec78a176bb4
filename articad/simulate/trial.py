"""Trials in processes of their own: `python -m articad.simulate.trial ENGINE FILE DRIVERS` prints what an engine measured as JSON."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

from articad.simulate.loading import MEMORY, Engine, answer_in, load
from articad.simulate.verdict import Outcome

SECONDS = 300.0


def try_out(engine: Engine, path: Path, *, drivers: tuple[str, ...] | None = None, seconds: float = SECONDS) -> Outcome:
    """Have an engine load a model and move it, in a process of its own with bounded time and memory.

    Args:
        engine: "mujoco" or "pybullet".
        path: A URDF or MJCF file.
        drivers: Joints that drive closed loops; None where nobody knows.
        seconds: After which it is ended.
    """
    loading = load(engine, path)
    if not loading.loads:
        return Outcome(engine, loading.version, loads=loading.loads, message=loading.message)
    package = Path(__file__).resolve().parents[2]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, [str(package), os.environ.get("PYTHONPATH")]))}
    command = [sys.executable, "-m", "articad.simulate.trial", engine, str(path.resolve()), json.dumps(drivers)]
    with tempfile.TemporaryDirectory(prefix="articad-trial-") as scratch:
        try:
            done = subprocess.run(  # noqa: S603 - ourselves
                command, cwd=scratch, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds, check=False
            )
        except subprocess.TimeoutExpired:
            return Outcome(engine, loading.version, loads=False, message=f"it was not done after {seconds:g} s")
    try:
        return Outcome.from_json(answer_in(done.stdout))
    except (ValueError, IndexError, TypeError):
        return Outcome(engine, loading.version, loads=False, message=f"its process ended with exit code {done.returncode}")


def main(arguments: list[str]) -> int:
    """Try a model out and print what was measured."""
    engine, path, drivers = arguments
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    names = json.loads(drivers)
    if engine == "mujoco":
        from articad.simulate.mujoco_trial import Trial  # noqa: PLC0415 - each process loads one engine

        outcome = Trial.of(Path(path)).run(None if names is None else tuple(names))
    else:
        from articad.simulate.bullet_trial import run  # noqa: PLC0415

        outcome = run(Path(path))
    print("\n" + json.dumps(asdict(outcome)))  # noqa: T201 - this is the answer; PyBullet may have left a line open
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
