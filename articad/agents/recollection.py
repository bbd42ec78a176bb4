"""Recollection: what the agents ask the stores of experience and documentation, and the answers that a run keeps.

Retrieved text is part of a prompt, so it is kept in the run: a replay needs no store, and a store that has grown since changes nothing.
Cases and snippets are data to whoever reads them: they are shown as they were written, each line behind a mark of quotation, so that none
can end the section that contains it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from articad.agents.late import ENDING
from articad.agents.llm import LLM, system, user
from articad.agents.prompts import prompt
from articad.agents.replies import ReplyForm, ask, reader, schema_of
from articad.agents.requirements import Requirements
from articad.agents.retrieval import Documentation, Memory, NoDocumentation, NoMemory, Recalled
from articad.agents.review import scores
from articad.aliases import Json
from articad.memory.case import Case
from articad.memory.distil import case_of
from articad.memory.documentation import DocumentationStore
from articad.memory.experience import ExperienceStore
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run

_LEAST: Final = 0.6  # similarity of requests below which a case is of another kind of product; docs/decisions/017
_LEAST_PART: Final = 0.9  # of specifications, which all resemble each other: of two products, 99 pairs of 100 are below 0.84
_CASES: Final = 2  # of each kind, for a designer
_EXAMPLES: Final = 1  # parts that an author of scripts is shown
_DESIGN_CHARACTERS: Final = 4000  # of a case's design
_SCRIPT_CHARACTERS: Final = 6000
_REPAIRS: Final = 8  # findings of a case that were resolved on the way
_NAMES: Final = 12  # names of an API that are looked up at once


class StoredMemory:
    """Experience from a store: designers see good and bad runs, authors of scripts only good ones.

    Args:
        store: The store.
    """

    def __init__(self, store: ExperienceStore) -> None:
        self._store = store

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:
        """Return the cases most similar to a request: good ones as heuristics, bad ones as constraints."""
        text = f"{prompt}\n{requirements.summary}".strip()
        good, issue = (self._store.like_request(text, kind, limit=_CASES, least=_LEAST) for kind in ("good", "issue"))
        return Recalled([_heuristic(hit.case) for hit in good], [_constraint(hit.case) for hit in issue])

    def for_part(self, specification: str, kernel: str) -> Sequence[str]:
        """Return example parts with a similar specification, in the kernel's dialect, from good cases only."""
        hits = self._store.like_part(specification, kernel, limit=_EXAMPLES, least=_LEAST_PART)
        parts = [next(part for part in hit.case.parts if part.name == hit.item and part.kernel == kernel) for hit in hits]
        return [f"Specification:\n{_quoted(part.specification)}\n\n{_fenced(part.script)}" for part in parts]


class _Names(ReplyForm):
    """What somebody who knows the API would look up."""

    names: list[str]


class StoredDocumentation:
    """A kernel's documentation: a model says which names it would use, the store answers with exact signatures."""

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:
        """Ask which names a part would need, and return what the kernel's own documentation says about them."""
        store = DocumentationStore("freecad" if kernel == "freecad" else "build123d")
        messages = (system(prompt("docs", kernel=kernel)), user(f"The specification:\n\n{specification}"))
        wanted = ask(llm, "docs", f"docs/{name}", messages, reader(_Names), schema=schema_of(_Names))
        return [str(entry) for entry in store.named(wanted.names, _NAMES)]


class KeptMemory:
    """Experience as a run keeps it: retrieved once, and the same again when the run is resumed or replayed.

    Args:
        run: Where it is kept.
        memory: Source of cases.
        recorded: A run whose retrieved texts are used instead, for a replay.
    """

    def __init__(self, run: Run, memory: Memory | None = None, *, recorded: Run | None = None) -> None:
        self._run, self._recorded, self._memory = run, recorded, memory or NoMemory()

    def for_design(self, prompt: str, requirements: Requirements) -> Recalled:
        """Return what helps to design a product."""

        def asked() -> Json:
            recalled = self._memory.for_design(prompt, requirements)
            return {"heuristics": list(recalled.heuristics), "constraints": list(recalled.constraints)}

        kept = _kept(self._run, self._recorded, "design", asked)
        return Recalled(kept.get("heuristics", ()), kept.get("constraints", ()))

    def for_part(self, specification: str, kernel: str) -> Sequence[str]:
        """Return worked examples of similar parts."""
        label = f"part.{_mark(kernel, specification)}"
        kept = _kept(self._run, self._recorded, label, lambda: {"examples": list(self._memory.for_part(specification, kernel))})
        return list(kept.get("examples", ()))


class KeptDocumentation:
    """Documentation as a run keeps it, like `KeptMemory`."""

    def __init__(self, run: Run, documentation: Documentation | None = None, *, recorded: Run | None = None) -> None:
        self._run, self._recorded, self._documentation = run, recorded, documentation or NoDocumentation()

    def for_part(self, name: str, specification: str, kernel: str, llm: LLM) -> Sequence[str]:
        """Return what helps to write a part's script."""

        def asked() -> Json:
            return {"entries": list(self._documentation.for_part(name, specification, kernel, llm))}

        return list(_kept(self._run, self._recorded, f"docs.{_mark(kernel, specification)}", asked).get("entries", ()))


def remember(run: Run, store: ExperienceStore) -> Case | None:
    """Summarise a finished run as a case and add it to a store; return the case, or None if the run has no assembly."""
    text, checks = run.plan_text(), run.checks()
    if text is None or checks is None:
        return None
    resolved = resolve(AssemblyPlan.loads(text))
    scripts = {name: script for name in run.part_names() if name in resolved.parts and (script := run.script(name)) is not None}
    scripts = {name: script for name, script in scripts.items() if not script.endswith(ENDING)}  # not examples: they define no connectors
    verdict, review = run.verdict() or {}, run.review() or {}
    measured = [finding for finding in checks["findings"] if finding["severity"] == "error"]
    judged = [finding for finding in verdict.get("findings", ()) if finding["severity"] == "error" and finding not in measured]
    case = case_of(
        resolved,
        scripts,
        kernel=str(run.request.options.get("kernel", "build123d")),
        prompt=_wanted(run),
        requirements=str((run.requirements() or {}).get("summary", "")),
        defects=[_defect(finding) for finding in (*measured, *judged)],
        repairs=_repairs(run),
        scores=scores(run) | {aspect: float(scored["score"]) for aspect, scored in (review.get("model") or {}).items()},
        lessons=review.get("lessons", ()),
        version=run.version,
    )
    store.add(case)
    return case


def _kept(run: Run, recorded: Run | None, label: str, asked: Callable[[], Json]) -> Json:
    """Return what was retrieved under a label; the source is asked only once."""
    stored = run.recalled(label)
    if stored is not None:
        return stored
    retrieved = asked() if recorded is None else recorded.recalled(label) or {}
    if any(retrieved.values()):  # an empty result is not stored: an empty store equals none
        run.save_recalled(label, retrieved)
    return retrieved


def _mark(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:16]


def _wanted(run: Run) -> str:
    """Return the request of a run; for an edit, with the request of its base."""
    base = run.base()
    return run.prompt if base is None else f"{base['prompt']}\n\nChanged since: {run.prompt}"


def _heuristic(case: Case) -> str:
    mended = f"\nMended on the way:\n{_quoted('; '.join(case.repairs))}" if case.repairs else ""
    return f"Asked for:\n{_quoted(case.prompt)}\nDesigned:\n{_quoted(case.design[:_DESIGN_CHARACTERS])}{mended}{_learned(case)}"


def _constraint(case: Case) -> str:
    return f"Asked for:\n{_quoted(case.prompt)}\nFound at the end:\n{_quoted('; '.join(case.defects))}{_learned(case)}"


def _learned(case: Case) -> str:
    return f"\nLearned:\n{_quoted(' '.join(case.lessons))}" if case.lessons else ""


def _quoted(text: str) -> str:
    """Return text as it was written, each of its lines behind a mark: whatever it contains, no line of it begins a section."""
    return "\n".join(f"> {line}" for line in text.splitlines())


def _fenced(script: str) -> str:
    """Return a script as a block that nothing in it can close."""
    return f"```python\n{script[:_SCRIPT_CHARACTERS].replace('```', '')}\n```"


def _defect(finding: Mapping[str, Any]) -> str:
    return f"{finding['code']} {finding['where']}: {finding['message']} {finding['hint']}"


def _repairs(run: Run) -> list[str]:
    """Return what went wrong on the way: the findings of failed attempts, each once."""
    told: dict[str, None] = {}
    for name in run.part_names():
        number = 1
        while (attempt := run.attempt(name, number)) is not None:
            for finding in attempt.get("findings", ()):
                told[_defect(finding)] = None
            number += 1
    return list(told)[:_REPAIRS]
