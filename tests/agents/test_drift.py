"""A replay that makes other files says which, by how much, and what the two runs were made with."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from articad.agents import drift
from articad.agents.pipeline import Replayed, generate, replay
from articad.agents.settings import Services
from articad.findings import Findings
from articad.kernels.kernel import BuildCache
from articad.kernels.results import read_mesh
from articad.runs.run import Run
from tests.agents import stories
from tests.crash.stand_in import FixedKernel

OPTIONS = {"look": False, "inspection": False, "ideas": "never", "rounds": 1, "jobs": 1}


class OtherKernel(FixedKernel):
    version = "other"


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    generate(
        stories.FLAP_PROMPT,
        llm=stories.flap(),
        out=tmp_path / "run",
        **stories.settings(kernel=FixedKernel(), cache=BuildCache(None), **OPTIONS),
    )
    return tmp_path / "run"


def again(recorded: Path, kernel: FixedKernel | None = None) -> Replayed:
    return replay(
        recorded, out=recorded.parent / "again", services=Services(kernel=kernel or FixedKernel(), cache=BuildCache(None), jobs=1)
    )


def moved(recorded: Path, by: float) -> None:
    """Move one vertex of a recorded mesh [mm]."""
    file = next(recorded.glob("parts/*/part.npz"))
    mesh = read_mesh(file.read_bytes())
    assert mesh.face is not None
    vertices = mesh.vertices.copy()
    vertices[0, 0] += by
    stream = io.BytesIO()
    np.savez(stream, vertices=vertices, triangles=mesh.triangles, face=mesh.face)
    file.write_bytes(stream.getvalue())


def test_the_trace_says_what_a_run_is_made_with_and_is_not_compared(recorded: Path) -> None:
    noted = [event["made_with"] for event in Run.view(recorded).events() if "made_with" in event]

    assert noted == [drift.made_with(FixedKernel())]
    assert noted[0]["kernel"] == "build123d fixed"
    assert again(recorded).ok


def test_rounding_of_another_kernel_is_drift_and_names_both(recorded: Path) -> None:
    moved(recorded, 1e-9)
    replayed = again(recorded, OtherKernel())

    (finding,) = replayed.findings.of("W_REPLAY_DRIFT")
    assert replayed.ok
    assert "kernel build123d fixed, now build123d other" in finding.message
    assert finding.value == pytest.approx(1e-9, rel=1e-3)


@pytest.mark.parametrize(("by", "kernel"), [(1e-5, OtherKernel()), (1e-9, FixedKernel())], ids=["too far", "same kernel"])
def test_geometry_that_is_off_or_has_no_reason_differs(recorded: Path, by: float, kernel: FixedKernel) -> None:
    moved(recorded, by)
    replayed = again(recorded, kernel)

    assert not replayed.ok
    assert replayed.findings.codes == ("E_REPLAY_DIFFERS",)
    reason = "now build123d other" if kernel.version == "other" else "the same versions on the same platform"
    assert reason in replayed.findings[0].message


@pytest.mark.parametrize(("file", "kind"), [("plan.json", "the plan"), ("checks.json", "results"), ("parts/flap/script.py", "scripts")])
def test_plan_scripts_and_results_must_be_equal_whatever_the_kernel(recorded: Path, file: str, kind: str) -> None:
    (recorded / file).write_bytes((recorded / file).read_bytes() + b"\n")
    replayed = again(recorded, OtherKernel())

    assert not replayed.ok
    assert f"files of {kind} differ" in " ".join(finding.message for finding in replayed.findings.of("E_REPLAY_DIFFERS"))


def test_a_recording_that_says_nothing_of_itself_is_told_so(recorded: Path) -> None:
    (recorded / "trace.jsonl").unlink()
    moved(recorded, 1e-9)

    assert "does not say what it was made with" in again(recorded).findings[0].message


def test_a_mesh_that_cannot_be_read_differs(recorded: Path) -> None:
    next(recorded.glob("parts/*/part.npz")).write_bytes(b"spoilt")

    assert isinstance(again(recorded).findings, Findings)
    assert not Replayed(Run.view(recorded), ("parts/flap/part.npz",), Findings()).ok
