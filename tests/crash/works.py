"""Work that is killed and taken up again: a function of a folder, and what must be equal in the end.

A work's result is its files by their hashes; times stand in traces alone, which are left out. A store of any kind joins
here: a function that commits numbered records to a folder and says so after each, and one that reads them back.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from articad.agents.edit import edit
from articad.agents.live import LiteLLM
from articad.agents.llm import LLM, Replay, Reply, Request, Scripted
from articad.agents.pipeline import generate
from articad.assembly import Assembly
from articad.batches.batch import run_local
from articad.batches.items import ITEM, BatchItem
from articad.kernels.build123d import Build123dKernel
from articad.kernels.kernel import BuildCache, PartKernel
from articad.memory.case import Case
from articad.memory.experience import ExperienceStore
from articad.plan.schema import AssemblyPlan
from articad.processes import scratch
from articad.runs.record import record_assembly, record_certificate, record_checks, record_export
from articad.runs.run import Run, RunRequest, digest, open_or_create
from tests.agents import stories
from tests.crash.stand_in import FixedKernel

FIVE_JOINTS = stories.FIXTURES / "five_joints"
OPTIONS = {"look": False, "inspection": False, "ideas": "never", "rounds": 1, "jobs": 2}


class Counted:
    """Counts calls in a file, one byte each, so that they outlive the process that made them."""

    def __init__(self, llm: LLM, tally: Path) -> None:
        self._llm, self._tally = llm, tally

    def complete(self, request: Request) -> Reply:
        """Count, and answer."""
        with self._tally.open("ab") as stream:
            stream.write(b".")
        return self._llm.complete(request)


@cache
def kernel(name: str) -> PartKernel:
    """Return a kernel by its name; the fixed one has no process."""
    return FixedKernel() if name == "fixed" else Build123dKernel()


def build(folder: Path, kernel_name: str = "fixed") -> Assembly:
    """What `articad build` does: build, record, check, export."""
    plan = AssemblyPlan.load(FIVE_JOINTS)
    scripts = {part.stem: part.read_bytes() for part in (FIVE_JOINTS / "parts").glob("*.py") if "." not in part.stem}
    assembly = Assembly.from_plan(plan, scripts, kernel=kernel(kernel_name), cache=BuildCache(folder / "cache"), jobs=2)
    with open_or_create(RunRequest(prompt=plan.name, options={"task": "build", "kernel": "build123d"}), folder / "run") as run:
        run.save_plan(plan.dumps(), 0)
        record_assembly(run, assembly)
        record_checks(run, assembly.check())
        for name in ("urdf", "mjcf"):
            record_export(run, assembly, name)
    return assembly


def proven(folder: Path, kernel_name: str = "fixed") -> None:
    """What `articad certify` does with the run in the folder."""
    with Run.open(folder / "run") as run:
        record_certificate(run, _restored(run, folder, kernel_name).certify(pairs=False, budget=0.1))


def exported(folder: Path, kernel_name: str = "fixed") -> None:
    """What `articad export` does with the run in the folder."""
    with Run.open(folder / "run") as run:
        assembly = _restored(run, folder, kernel_name)
        for name in ("urdf", "mjcf", "sdf", "usd", "glb", "3mf", "plan"):
            record_export(run, assembly, name)


def _restored(run: Run, folder: Path, kernel_name: str) -> Assembly:
    """Return the assembly of a run, as `assembly_of` does, with a kernel of this module."""
    scripts = {name: script for name in run.part_names() if (script := run.script(name)) is not None}
    plan = AssemblyPlan.loads(run.plan_text() or "")
    return Assembly.from_plan(plan, scripts, kernel=kernel(kernel_name), cache=BuildCache(folder / "cache"))


def generated(folder: Path, kernel_name: str = "fixed", recording: Path | None = None) -> None:
    """What `articad generate` does, answered from a recording."""
    llm: LLM = stories.flap() if recording is None else Counted(Replay(recording), folder / "calls")
    generate(
        stories.FLAP_PROMPT,
        llm=llm,
        out=folder / "run",
        **stories.settings(kernel=kernel(kernel_name), cache=BuildCache(folder / "cache"), **OPTIONS),
    )


def live(folder: Path, address: str) -> None:
    """What `articad generate` does with an endpoint; each call is a process of its own."""
    llm = Counted(LiteLLM("stub", api_base=address), folder / "calls")
    given = stories.settings(kernel=kernel("fixed"), cache=BuildCache(folder / "cache"), **OPTIONS)
    generate(stories.FLAP_PROMPT, llm=llm, out=folder / "run", **given)


def batch(folder: Path) -> None:
    """What `articad batch` does: items in worker processes with the real kernel."""
    os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
    plan = folder / "plan"
    (plan / "parts").mkdir(parents=True, exist_ok=True)
    (plan / "plan.json").write_text(json.dumps(stories.FLAP_PLAN))
    for name, script in stories.FLAP_SCRIPTS.items():
        (plan / "parts" / f"{name}.py").write_text(script)
    items = [BatchItem(str(plan), {"lift": lift}, formats=("urdf", "step")) for lift in (1.0, 1.5, 2.0)]
    records = run_local(items, folder / "run", workers=2)
    assert all(record["ok"] for record in records), records


def edited(folder: Path, recording: Path) -> None:
    """What `articad edit` does with a recorded run, answered by a script."""
    change = {"summary": "x", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3}}
    llm = Counted(Scripted({"edit/1": json.dumps(change)}), folder / "calls")
    options = {name: value for name, value in OPTIONS.items() if name != "ideas"}
    edit(
        recording,
        "a thicker flap",
        llm=llm,
        out=folder / "run",
        **stories.settings(kernel=kernel("fixed"), cache=BuildCache(folder / "cache"), **options),
    )


def files(folder: Path) -> Mapping[str, str]:
    """Return the hashes of everything in a run but its trace, and hold that nothing is half-written or left over."""
    if not (folder / "run/request.json").exists():
        return batch_files(folder / "run")
    hashes = Run.view(folder / "run").hashes()
    strangers = [name for name in hashes if scratch.BESIDE in name]
    assert not strangers, strangers
    for name in hashes:
        if name.endswith(".json"):
            json.loads((folder / "run" / name).read_bytes())
    return hashes


def batch_files(folder: Path) -> Mapping[str, str]:
    """Return the hashes of everything in a batch; of the records of its items, what is not a time or a count of the cache."""
    hashes = {}
    for path in folder.rglob("*"):
        name = path.relative_to(folder).as_posix()
        assert scratch.BESIDE not in name, f"{name} was left behind"
        if path.name == ITEM:
            record = {
                key: value
                for key, value in json.loads(path.read_bytes()).items()
                if key not in {"plan", "seconds", "parts_built", "parts_kept"}
            }
            hashes[name] = digest(record)
        elif path.is_file():
            hashes[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return hashes


# ---------------------------------------------------------------------- stores


@dataclass(frozen=True)
class Store:
    """A store that takes numbered records.

    Attributes:
        write: Commits record `number` of writer `writer`; when it returns, the record must outlive a kill.
        read: Returns the records that are there, by writer and number; raises if any is torn.
    """

    write: Callable[[Path, int, int], None]
    read: Callable[[Path], set[tuple[int, int]]]


def _write_part(folder: Path, writer: int, number: int) -> None:
    with BuildCache(folder).writing(f"d{number}") as empty:
        for name in ("a", "b"):
            (empty / name).write_text(f"{number} {name} " * 2000)
    # every writer writes the same digests: whoever is first, the folder must be whole
    assert writer >= 0


def _read_parts(folder: Path) -> set[tuple[int, int]]:
    cache_of_it, found = BuildCache(folder), set()
    for entry in folder.glob("d*"):
        number = int(entry.name[1:])
        whole = cache_of_it.get(entry.name)
        assert whole is not None, f"{entry.name} is torn"
        assert (whole / "b").read_text() == f"{number} b " * 2000
        found.add((0, number))
    return found


def _write_line(folder: Path, writer: int, number: int) -> None:
    """A run's trace: one line a record, each writer in a run of its own, for a run has one writer."""
    path = folder / f"run{writer}"
    with open_or_create(RunRequest(prompt=f"{writer}"), path) as run:
        run.save_requirements({"number": number})
        run.trace("note", number=number)


def _read_lines(folder: Path) -> set[tuple[int, int]]:
    found = set()
    for path in folder.glob("run*"):
        with Run.open(path) as run:  # a torn line is ended, and skipped
            found |= {(int(path.name[3:]), int(event["number"])) for event in run.events()}
            kept = run.requirements()
            assert kept is None or isinstance(kept["number"], int)
    return found


def _write_case(folder: Path, writer: int, number: int) -> None:
    ExperienceStore(folder).add(Case(kind="good", prompt=f"{writer} {number}", design="words " * 500))


def _read_cases(folder: Path) -> set[tuple[int, int]]:
    told = (case.prompt.split() for case in ExperienceStore(folder).cases())
    return {(int(writer), int(number)) for writer, number in told}


STORES: Mapping[str, Store] = {
    "cache of parts": Store(_write_part, _read_parts),
    "trace of a run": Store(_write_line, _read_lines),
    "experience": Store(_write_case, _read_cases),
}


def write_for_ever(store: Store, folder: Path, writer: int, told: int) -> None:
    """Commit record after record, and say each number on a pipe once it is committed."""
    number = 0
    while True:
        number += 1
        store.write(folder, writer, number)
        os.write(told, f"{number}\n".encode())
