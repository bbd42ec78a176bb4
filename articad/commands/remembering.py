"""Inspect, fill, prune and transfer the store of earlier runs."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from articad.bounds import TEXT_BYTES, TEXT_VALUES, values_in
from articad.commands.command import argument, command
from articad.commands.options import API_BASE, EMBEDDINGS, MEMORY, positive, words
from articad.commands.steps import experience
from articad.files import read_file

if TYPE_CHECKING:
    from articad.commands.terminal import Report, Terminal
    from articad.memory.case import Case
    from articad.memory.experience import ExperienceStore

_WHAT: Final = {  # each action, and the argument that it needs
    "list": "",
    "show": "a case's id",
    "search": "a request",
    "seed": "",
    "export": "a file to write",
    "import": "a file of cases",
    "remove": "a case's id",
    "prune": "",
}
_LIKE: Final = 5  # cases of each kind that a search shows
_WORDS: Final = 60  # characters of a request in a table


@command(
    "memory",
    "List, search, fill or prune the experience of earlier runs.",
    argument("action", choices=list(_WHAT), help="what to do"),
    argument(
        "what", type=words, nargs="?", metavar="ID|TEXT|FILE", help="a case to show or remove; a request to search for; a file of cases"
    ),
    MEMORY,
    EMBEDDINGS,
    API_BASE,
    argument("--keep", metavar="N", type=positive, default=1000, help="cases of each kind that prune keeps (1000)"),
)
def _memory(options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.errors import ReadError

    store = experience(options)
    if _WHAT[options.action] and not options.what:
        raise ReadError(f"`articad memory {options.action}` needs one more argument: {_WHAT[options.action]}.", path="memory")
    report = _ACTIONS[options.action](store, options, terminal)
    return {"schema": "articad.memory/1", "ok": True, "store": str(store.folder), "findings": []} | report


def _list(store: ExperienceStore, _options: argparse.Namespace, terminal: Terminal) -> Report:
    cases = store.cases()
    terminal.table(["id", "kind", "parts", "request"], [_row(case) for case in cases])
    terminal.say(f"{len(cases)} cases in {store.folder}.")
    return {"cases": [_summary(case) for case in cases]}


def _show(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    case = store.case(options.what)
    terminal.text(f"{case.id}, {case.kind}: {case.request}\n\n{case.design}")
    for title, lines in (("Defects", case.defects), ("Repaired on the way", case.repairs), ("Learned", case.lessons)):
        if lines:
            terminal.text("\n".join(["", f"{title}:", *lines]))
    terminal.say()
    terminal.say(f"Scripts: {', '.join(f'{part.name} ({part.kernel})' for part in case.parts)}")
    return {"case": case.to_json()}


def _search(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    hits = [hit for kind in ("good", "issue") for hit in store.like_request(options.what, kind, limit=_LIKE)]
    terminal.table(["likeness", "id", "kind", "parts", "request"], [(f"{hit.likeness:.2f}", *_row(hit.case)) for hit in hits])
    return {"hits": [{"likeness": round(hit.likeness, 3)} | _summary(hit.case) for hit in hits]}


def _seed(store: ExperienceStore, _options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad import examples
    from articad.memory.distil import case_of
    from articad.plan.resolve import resolve
    from articad.plan.schema import AssemblyPlan

    cases = []
    for name in examples.names():
        resolved = resolve(AssemblyPlan.load(examples.folder(name)))
        written = {part: examples.folder(name) / "parts" / f"{part}.py" for part in resolved.parts}
        scripts = {part: file.read_bytes() for part, file in written.items() if file.is_file()}
        cases.append(case_of(resolved, scripts, kernel="build123d", prompt=resolved.plan.description or name))
    return _added(store, store.add(*cases), terminal)


def _export(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    from articad.runs.run import write_atomically

    lines = list(store.export())
    write_atomically(Path(options.what), "".join(f"{line}\n" for line in lines).encode())
    terminal.say(f"{len(lines)} cases written to {options.what}.")
    return {"file": options.what, "count": len(lines)}


def _text(path: Path) -> str:
    from articad.errors import ReadError

    try:
        content = read_file(path, TEXT_BYTES)
        if values_in(content) > TEXT_VALUES:
            raise ReadError.at(path, f"{path} has more than {TEXT_VALUES} values.", "Import it in pieces: each line is a case.")
        return content.decode()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8"
        raise ReadError.at(path, f"{path} cannot be read: {reason}.", "Name a file that `articad memory export` wrote.") from None


def _import(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    return _added(store, store.import_lines(_text(Path(options.what)).splitlines()), terminal)


def _remove(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    case = store.case(options.what)
    store.remove(case.id)
    terminal.say(f"Forgotten: {case.id}, {case.request[:_WORDS]}")
    return {"removed": case.id}


def _prune(store: ExperienceStore, options: argparse.Namespace, terminal: Terminal) -> Report:
    count = store.prune(options.keep)
    terminal.say(f"{count} cases removed, {len(store)} left.")
    return {"removed": count}


def _added(store: ExperienceStore, count: int, terminal: Terminal) -> Report:
    terminal.say(f"{count} new cases, {len(store)} in {store.folder}.")
    return {"added": count}


def _row(case: Case) -> tuple[str, str, str, str]:
    request = " ".join(case.request.split())
    return case.id[:8], case.kind, str(len(case.parts)), request if len(request) <= _WORDS else f"{request[: _WORDS - 1]}…"


def _summary(case: Case) -> Report:
    return {"id": case.id, "kind": case.kind, "prompt": case.prompt, "parts": [part.name for part in case.parts], "defects": case.defects}


_ACTIONS: Final[Mapping[str, Callable[[ExperienceStore, argparse.Namespace, Terminal], Report]]] = {
    "list": _list,
    "show": _show,
    "search": _search,
    "seed": _seed,
    "export": _export,
    "import": _import,
    "remove": _remove,
    "prune": _prune,
}
