"""Drift: where a replay differs from its recording, and why: another version, kernel or platform, or files changed since."""

from __future__ import annotations

import math
import platform
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from articad.files import RECORD_BYTES, read_file
from articad.findings import Finding, Findings
from articad.kernels.kernel import PartKernel
from articad.kernels.results import PoisonedError, read_mesh
from articad.runs.run import Run

SAME_MM = 1e-6  # tolerance for geometry made by another kernel or platform
_NOTE = "made_with"
_SHOWN = 3  # files that a finding names
_GEOMETRY = ("part.npz", "part.brep", "part.step", "part.stl", "part.FCStd", "part.json", "connectors.json")


def note(run: Run, kernel: PartKernel) -> None:
    """Write the versions that a run is made with into its trace, which is never compared."""
    run.trace("note", **{_NOTE: made_with(kernel)})


def made_with(kernel: PartKernel) -> dict[str, str]:
    """Return the versions and the platform on which a run's files depend."""
    from articad import __version__  # noqa: PLC0415 - the package's own version, without a cycle at import

    return {
        "articad": __version__,
        "kernel": f"{kernel.name} {kernel.version}",
        "platform": f"{platform.system()} {platform.machine()} {' '.join(platform.libc_ver())}".strip(),
        "numpy": np.__version__,
    }


def drift(recorded: Run, again: Run, names: Sequence[str]) -> Findings:
    """Return one finding for each kind of file that differs: how much, and what the two runs were made with.

    Args:
        recorded: The recording.
        again: Its replay.
        names: Files that are not equal in both runs, by their paths.
    """
    kinds: dict[str, list[str]] = {}
    for name in names:
        kinds.setdefault(_kind(name), []).append(name)
    why, other = _why(_noted(recorded), _noted(again))
    return Findings(_finding(kind, files, recorded, again, why, other=other) for kind, files in kinds.items() if kind != "answers")


def _finding(kind: str, files: list[str], recorded: Run, again: Run, why: str, *, other: bool) -> Finding:
    shown = ", ".join(files[:_SHOWN]) + (f" and {len(files) - _SHOWN} more" if len(files) > _SHOWN else "")
    message = f"{len(files)} files of {kind} differ from the recording ({shown})."
    far = _distance(recorded, again, files) if kind == "geometry" else math.inf
    if math.isfinite(far):
        message += f" Meshes differ by {far:.2g} mm at most."
    harmless = other and (far <= SAME_MM or kind == "exports")
    hint = (
        "Nothing needs to be done: another kernel or platform rounds differently."
        if harmless
        else "Replay with the versions that recorded it, or record again."
    )
    return Finding(
        code="W_REPLAY_DRIFT" if harmless else "E_REPLAY_DIFFERS",
        where=files[0],
        message=f"{message} {why}",
        hint=hint,
        value=far if math.isfinite(far) else None,
        limit=SAME_MM if math.isfinite(far) else None,
        unit="mm" if math.isfinite(far) else None,
    )


def _kind(name: str) -> str:
    if name.startswith("llm/"):
        return "answers"  # each is reported as a prompt that drifted
    if name.startswith("plan"):
        return "the plan"
    if name.endswith("script.py"):
        return "scripts"
    if name.startswith("export/"):
        return "exports"
    return "geometry" if name.endswith(_GEOMETRY) else "results"


def _noted(run: Run) -> Mapping[str, str]:
    """Return what a run was made with according to its trace; the last note counts."""
    notes = [event[_NOTE] for event in run.events() if isinstance(event.get(_NOTE), dict)]
    return {str(key): str(value) for key, value in notes[-1].items()} if notes else {}


def _why(before: Mapping[str, str], now: Mapping[str, str]) -> tuple[str, bool]:
    """Return the reason in words, and whether anything on which geometry depends has changed or is unknown."""
    if not before:
        return "The recording does not say what it was made with.", True
    changed = [
        f"{key} {before.get(key, 'unknown')}, now {now.get(key, 'unknown')}"
        for key in sorted({*before, *now})
        if before.get(key) != now.get(key)
    ]
    if changed:
        return f"It was made with {'; '.join(changed)}.", True
    return (
        "It was made with the same versions on the same platform: one of the two runs was changed since, or this is a defect of articad.",
        False,
    )


def _distance(recorded: Run, again: Run, files: Sequence[str]) -> float:
    """Return the largest distance between corresponding vertices [mm]; infinite if the numbers of vertices differ, 0 if no mesh differs."""
    return max((_apart(*pair) for pair in _meshes(recorded, again, files)), default=0.0)


def _meshes(recorded: Run, again: Run, files: Sequence[str]) -> Iterator[tuple[bytes, bytes]]:
    for name in files:
        if name.endswith("part.npz"):
            yield _content(recorded, name), _content(again, name)


def _content(run: Run, name: str) -> bytes:
    try:
        return read_file(run.path / name, RECORD_BYTES, root=run.path)
    except OSError:
        return b""


def _apart(first: bytes, second: bytes) -> float:
    try:
        a, b = read_mesh(first), read_mesh(second)
    except PoisonedError:
        return math.inf
    if a.vertices.shape != b.vertices.shape or not np.array_equal(a.triangles, b.triangles):
        return math.inf
    return float(np.abs(a.vertices - b.vertices).max(initial=0.0))
