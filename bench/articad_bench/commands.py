"""The command `articad bench`: run the benchmark with a model, or score the results of any tool."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from articad.commands.command import argument, command, output_folder
from articad.commands.options import ASKING, ENGINE, FORCE, SANDBOX, positive
from articad.commands.steps import build_cache, sandbox_level
from articad_bench.terminal_tables import print_data, print_judged, print_sentences, print_table

if TYPE_CHECKING:
    from articad.agents.llm import Budget
    from articad.agents.part_writer import Looks
    from articad.batches.pool import Call
    from articad.commands.terminal import Report, Terminal
    from articad_bench.judge import Judged
    from articad_bench.public_scores import Sampled
    from articad_bench.row import Row
    from articad_bench.task import Task


@command(
    "bench",
    "Run the benchmark with a model; score the files of any tool, or have models judge them; list the tasks, or draw their pictures; "
    "make variants of tasks that no leaked answer fits; plant faults, and count those that no check finds; try cheats, none of which may pass.",
    argument(
        "action",
        choices=["run", "score", "judge", "table", "list", "draw", "make", "shapes", "objects", "faults", "cheats"],
        help="what to do",
    ),
    argument(
        "what",
        nargs="?",
        metavar="DIR",
        help="score, judge: a folder of models named after tasks, or of a run; shapes, objects: of models named after samples; table: of a run",
    ),
    argument(
        "--data",
        metavar="DIR",
        help="your copy of CADPrompt (shapes), or of ACD, PartNet-Mobility or Fusion 360 joints (objects), for tasks",
    ),
    argument(
        "--refine", metavar="N", type=positive, default=None, help="same as --rounds N+1 --repairs N: how often an answer may be repaired"
    ),
    argument("--judge", metavar="NAME", dest="judges", action="append", default=[], help="a model that scores; repeat it for several"),
    argument("--tasks", metavar="DIR", help="folder of tasks (the project's own)"),
    argument(
        "--some",
        metavar="N",
        type=positive,
        default=None,
        help="faults: only N cases, spread over all kinds; cheats: only N tasks, of those without results (all)",
    ),
    argument("--case", metavar="NAME", dest="cases", action="append", default=[], help="faults: try this one again, PRODUCT:KIND or KIND"),
    argument("--repair", action="store_true", help="faults: also follow the hints, and build what results"),
    argument("--task", metavar="NAME", dest="names", action="append", default=[], help="only this one; may be repeated"),
    argument(
        "--sentences", action="store_true", help="list: which check holds each number of a task, and which sentence states each check"
    ),
    argument(
        "--seed", metavar="N", type=positive, default=1, help="make: which variant of each task; the same seed gives the same variants (1)"
    ),
    argument("--kind", choices=["articulated", "static", "industrial", "hard", "separating"], default=None, help="only tasks of this kind"),
    output_folder(
        "--out", "bench", "where rows, runs, variants and the tables of faults and cheats are kept; existing rows are not made again"
    ),
    argument(
        "--variant",
        choices=["full", "late", "no-rollback", "no-memory", "single-loop"],
        default="full",
        help="the paper's ablations (full)",
    ),
    argument(
        "--kernel", choices=["build123d", "freecad"], default="build123d", help="the kernel for which part scripts are written (build123d)"
    ),
    argument("--recorded", metavar="DIR", help="run: take the answers from these runs, named after tasks; needs no model, key or network"),
    argument(
        "--at-once",
        metavar="N",
        type=positive,
        default=1,
        help="tasks at the same time, each in a separate process; a single one runs in this process (1)",
    ),
    *ENGINE,
    *ASKING,
    SANDBOX,
    FORCE,
)
def _bench(options: argparse.Namespace, terminal: Terminal) -> Report:
    return _ACTIONS[options.action](options, terminal)


def _tasks(options: argparse.Namespace) -> list[tuple[Path, Task]]:
    """Return the selected tasks: the project's own, a folder's, or those of public data."""
    from articad_bench.task import TASKS, tasks_in

    return _asked_by_data(options) if options.data else tasks_in(options.tasks or TASKS, names=options.names, kind=options.kind)


def _needed(options: argparse.Namespace, *, data: bool = False) -> str:
    """Return the folder that an action is about."""
    from articad.errors import ReadError

    if not options.what or (data and not options.data):
        what = "the folder of what is to be scored" + (", and --data" if data else "")
        raise ReadError(f"`articad bench {options.action}` needs {what}.", path="bench")
    return _folder(options.what)


def _folder(named: str) -> str:
    """Return a folder that is to be read.

    Raises:
        ReadError: If there is none.
    """
    from articad.errors import ReadError

    if not Path(named).is_dir():
        raise ReadError.at(named, f"There is no folder {named}.", "Correct the name.", said=f"There is no folder {named}.")
    return named


def _table(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad_bench.row import rows_in
    from articad_bench.table import table

    return print_table(table(rows_in(_folder(options.what or options.out), options.names)), terminal)


def _score(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad_bench.remote import rows_of, score_calls
    from articad_bench.scoring import score_files
    from articad_bench.table import table

    models, tasks = _needed(options), _tasks(options)
    if options.engine == "local" and options.at_once == 1:
        return print_table(table(score_files(tasks, models)), terminal)
    return print_table(table(rows_of(tasks, _spread(score_calls(tasks, models), options, terminal))), terminal)


def _run(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands.models import asked_model, limits, model_name
    from articad_bench.remote import rows_of, run_calls
    from articad_bench.table import table

    if options.refine is not None:
        options.rounds, options.repairs = options.refine + 1, options.refine
    tasks = _tasks(options)
    if options.recorded:
        return print_table(table(_run_again(tasks, options, terminal)), terminal)
    _, sees = asked_model(options, terminal)  # says at once what is missing
    if options.engine == "dask" or options.at_once > 1:
        said: dict[str, Any] = {"model": model_name(options), "limits": limits(options), "sandbox": sandbox_level(options)}
        said |= {name: getattr(options, name) for name in ("vision_model", "judge_model", "api_base", "kernel", "memory", "force")}
        said |= {"variant": options.variant, "look": sees and options.look, "repairs": options.repairs, "rounds": options.rounds}
        return print_table(table(rows_of(tasks, _spread(run_calls(tasks, options.out, said), options, terminal))), terminal)
    return print_table(table(_run_here(tasks, options, terminal, look=sees and options.look)), terminal)


def _run_again(tasks: list[tuple[Path, Task]], options: argparse.Namespace, terminal: Terminal) -> list[Row]:
    from articad.kernels.choice import kernel_named
    from articad_bench.recorded import RecordedAnswers
    from articad_bench.runner import run_tasks

    answers = RecordedAnswers(options.recorded)
    with terminal.progress("Tasks", total=len(tasks)) as tell:
        return run_tasks(
            tasks,
            options.out,
            answers.of,
            ask_edit=answers.of_edit,
            variant=options.variant,
            kernel=kernel_named(options.kernel, sandbox=sandbox_level(options)),
            cache=build_cache(options),
            look=options.look,
            model="recorded",
            repairs=options.repairs,
            rounds=options.rounds,
            jobs=options.at_once,
            progress=lambda row: tell(row.task, "passed" if row.ok else "failed"),
        )


def _run_here(tasks: list[tuple[Path, Task]], options: argparse.Namespace, terminal: Terminal, *, look: Looks) -> list[Row]:
    from articad.agents.recollection import StoredMemory, remember
    from articad.commands.models import asked_model, model_name
    from articad.kernels.choice import kernel_named
    from articad.memory.experience import ExperienceStore
    from articad_bench.runner import run_tasks

    store = ExperienceStore(options.memory)
    with terminal.progress("Tasks", total=len(tasks)) as tell:
        return run_tasks(
            tasks,
            options.out,
            lambda _task: asked_model(options, terminal)[0],
            variant=options.variant,
            kernel=kernel_named(options.kernel, sandbox=sandbox_level(options)),
            cache=build_cache(options),
            memory=StoredMemory(store),
            look=look,
            model=",".join(name for name in (model_name(options), options.vision_model, options.judge_model) if name),
            repairs=options.repairs,
            rounds=options.rounds,
            finished=lambda run: remember(run, store),
            progress=lambda row: tell(row.task, "passed" if row.ok else "failed"),
        )


def _spread(
    calls: list[Call], options: argparse.Namespace, terminal: Terminal, keep: Callable[[Report], None] = lambda _answer: None
) -> list[Report]:
    """Make calls in processes, here or on a Dask cluster; each answer is kept as it comes."""
    from articad.batches.pool import run_dask, run_local

    with terminal.progress("Tasks", total=len(calls)) as tell:

        def told(answer: Report) -> None:
            keep(answer)
            tell(answer.get("task", "?"), "passed" if answer.get("ok") else "failed")

        if options.engine == "dask":
            return run_dask(calls, scheduler=options.scheduler, told=told)
        return run_local(calls, workers=options.at_once, told=told)


def _list(options: argparse.Namespace, terminal: Terminal) -> Report:
    tasks = [task for _, task in _tasks(options)]
    if options.sentences:
        from articad_bench.sentences import sentences

        return print_sentences({task.name: sentences(task) for task in tasks}, terminal)
    rows = [
        (task.name, task.kind, task.modality, task.product, len(task.checks), len(task.edits), str(task.budget or "")) for task in tasks
    ]
    terminal.table(["task", "kind", "asked by", "product", "checks", "edits", "budget"], rows)
    terminal.say(f"{len(tasks)} tasks.")
    return {"schema": "articad.bench-tasks/1", "ok": True, "findings": [], "tasks": [task.model_dump(mode="json") for task in tasks]}


def _on_data(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad_bench.public_data import objects_in, shapes_in
    from articad_bench.public_scores import score_objects, score_shapes

    models = _needed(options, data=True)

    def chosen(samples: Sequence[Any]) -> list[Any]:
        return [sample for sample in samples if not options.names or sample.name in options.names]

    with terminal.progress("Samples") as tell:

        def told(row: Sampled) -> None:
            tell(row.name, row.left_out or row.error or "scored")

        if options.action == "shapes":
            report = score_shapes(chosen(shapes_in(options.data)), models, told=told)
        else:
            report = score_objects(chosen(objects_in(options.data)), models, told=told)
    return print_data(report, terminal)


def _asked_by_data(options: argparse.Namespace) -> list[tuple[Path, Task]]:
    """Return public data as tasks, each in a folder of its own, so that workers can read them."""
    from articad.errors import ReadError
    from articad_bench.public_data import objects_in, shapes_in
    from articad_bench.task import write_task

    samples: list[Any]
    try:
        samples = list(shapes_in(options.data))
    except ReadError:
        samples = list(objects_in(options.data))
    chosen = [sample for sample in samples if not options.names or sample.name in options.names]
    return [write_task(sample.task(), Path(options.out) / "tasks" / sample.name, beside=sample.folder) for sample in chosen]


def _judge(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.commands.models import asked_model, model_name
    from articad_bench.judge import judge_files
    from articad_bench.judged_table import judged_table

    models, tasks = _needed(options), _tasks(options)

    def asked(name: str) -> Callable[[], Budget]:
        own = argparse.Namespace(**vars(options) | {"model": name, "vision_model": None, "judge_model": None})
        return lambda: asked_model(own, terminal)[0]

    names = options.judges or [model_name(options)]
    with terminal.progress("Opinions", total=len(tasks) * len(names)) as tell:

        def told(one: Judged) -> None:
            tell(f"{one.task} by {one.judge}", one.error or "scored")

        report = judged_table(judge_files(tasks, models, {name: asked(name) for name in names}, progress=told))
    print_judged(report, terminal)
    return report


def _draw(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.processes import scratch
    from articad_bench.pictures import pictures_of
    from articad_bench.reference import reference

    files = []
    for folder, task in _tasks(options):
        if task.drawing is not None:
            for name, content in pictures_of(reference(folder, task), task.drawing).items():
                file = folder / name
                scratch.write(file, content)
                terminal.say(f"{file}  {file.stat().st_size / 1000:.1f} kB")
                files.append(str(file))
    return {"schema": "articad.bench-drawings/1", "ok": True, "findings": [], "files": files}


def _make(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.errors import ArticadError
    from articad.kernels.choice import kernel_named
    from articad_bench.variants import make_variant

    made, left_out = [], {}
    kernel, cache = kernel_named("build123d", sandbox=sandbox_level(options)), build_cache(options)
    tasks = _tasks(options)
    with terminal.progress("Variants", total=len(tasks)) as tell:
        for folder, task in tasks:
            try:
                variant = make_variant(folder, task, options.seed, Path(options.out), cache=cache, kernel=kernel)
            except ArticadError as error:
                left_out[task.name] = str(error).splitlines()[0]
                tell(task.name, "left out")
                continue
            made.append({"task": task.name, "folder": str(variant.folder), "changed": variant.changed})
            tell(task.name, ", ".join(f"{name} {old:g} to {new:g}" for name, (old, new) in variant.changed.items()))
    for reason in left_out.values():
        terminal.say(reason)
    terminal.say(f"{len(made)} variants of {len(tasks)} tasks with seed {options.seed}.")
    return {
        "schema": "articad.bench-variants/1",
        "ok": bool(made),
        "findings": [],
        "seed": options.seed,
        "made": made,
        "left_out": left_out,
    }


def _faults(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.errors import ReadError, did_you_mean
    from articad.kernels.choice import kernel_named
    from articad_bench.fault_run import FaultRun
    from articad_bench.fault_table import alarms_line
    from articad_bench.fault_trial import Row as FaultRow
    from articad_bench.fault_trial import Tools, programs

    tools = Tools(kernel_named("build123d", sandbox=sandbox_level(options)), build_cache(options))
    run = FaultRun.of(options.names, options.some)
    run = FaultRun(run.faults, () if options.cases else run.products)
    known = {name for fault in run.faults for name in (fault.name, fault.kind.name)}
    for name in options.cases:
        if name not in known:
            message = f"There is no case or kind of mistake {name!r} of these products.{did_you_mean(name, known)}"
            raise ReadError.at("bench", message, "articad bench faults --out DIR writes the page faults.md, which lists all kinds.")

    def again(row: FaultRow) -> bool:
        is_chosen = not {row.case, row.kind}.isdisjoint(options.cases)
        is_old = row.programs != programs() or (options.repair and row.healed is None and row.counts)
        return bool(options.force or (is_chosen and is_old))

    with terminal.progress("Faults", total=len(run.faults)) as tell:
        told = run.work(Path(options.out), tools, again=again, repair=options.repair, tell=tell)
    for side in ("plan", "script", "all"):
        counts = told[side]
        terminal.say(
            f"{side}: {counts['cases']} cases, {counts['escaped']} escaped, {counts['named']} named, {counts['addressed']} addressed, "
            f"{counts['healed']} of {counts['repaired']} healed"
        )
    terminal.say(alarms_line(told))
    return told


def _cheats(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.kernels.choice import kernel_named
    from articad_bench.cheat_run import run_cheats
    from articad_bench.task import TASKS, tasks_in

    tasks, every = tasks_in(options.tasks or TASKS, names=options.names, kind=options.kind), tasks_in(options.tasks or TASKS)
    spread = None if options.at_once == 1 and options.engine == "local" else lambda calls, keep: _spread(calls, options, terminal, keep)
    with terminal.progress("Cheats") if spread is None else nullcontext(lambda _case, _outcome: None) as tell:
        told = run_cheats(
            tasks,
            Path(options.out),
            every=every,
            some=options.some,
            spread=spread,
            cache=build_cache(options),
            kernel=kernel_named(options.kernel, sandbox=sandbox_level(options)),
            again=options.force,
            tell=tell,
        )
    for task, cheat in told["passed"]:
        terminal.say(f"{task}: {cheat} passes")
    terminal.say(f"{told['cheats']} cheats of {told['tried']} of {told['tasks']} tasks tried; {len(told['passed'])} pass.")
    return told


_ACTIONS: Final[Mapping[str, Callable[[argparse.Namespace, Terminal], Report]]] = {
    "run": _run,
    "score": _score,
    "judge": _judge,
    "table": _table,
    "list": _list,
    "draw": _draw,
    "make": _make,
    "shapes": _on_data,
    "objects": _on_data,
    "faults": _faults,
    "cheats": _cheats,
}
