"""One request for the first scripts of several parts: their author gets the instructions once, and sees all their specifications.

An answer is split by its headings. A part without a script in it is asked for alone, and so is whatever must be repaired.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from typing import Final

from articad.agents.llm import LLM, Request, system, user
from articad.agents.part_writer import ROLE, Answer, instructions
from articad.agents.prompts import prompt
from articad.agents.retrieval import Documentation, Memory
from articad.plan.entry import specification
from articad.plan.resolve import ResolvedPlan

TOGETHER: Final = 6  # parts in one request: about 9,000 characters of scripts, and a product of 40 parts still fills seven requests
_HEADING: Final = re.compile(r"#{1,6}[ \t]*`?(\w+)`?[ \t]*:?")
LEAST: Final = 3  # two parts are written sooner side by side


def grouped(names: Sequence[str], most: int) -> list[tuple[str, ...]]:
    """Return names in groups of nearly equal size, in their order; none where there are fewer than `LEAST` names.

    Args:
        names: Parts without a script.
        most: Parts in one group.
    """
    return [] if min(len(names), most) < LEAST else evenly(names, most)


def evenly(names: Sequence[str], most: int) -> list[tuple[str, ...]]:
    """Return names in as few groups of at most `most` as possible, of nearly equal size, in their order."""
    count = -(-len(names) // most)
    edges = [len(names) * index // count for index in range(count + 1)] if count else [0]
    return [tuple(names[start:end]) for start, end in itertools.pairwise(edges)]


def asked_together(
    resolved: Mapping[str, ResolvedPlan], kernel: str, llm: LLM, *, step: str, memory: Memory, documentation: Documentation
) -> dict[str, Answer]:
    """Ask for the scripts of several parts at once.

    Args:
        resolved: By part, the plan that has its entry.
        kernel: The dialect of the scripts.
        llm: The model.
        step: Address of the request.
        memory: Source of worked examples.
        documentation: Source of the kernel's API.

    Returns:
        The answer for each part that has one.
    """
    entries = {name: specification(plan, name) for name, plan in resolved.items()}
    examples = [case for entry in entries.values() for case in memory.for_part(entry, kernel)]
    snippets = [text for name, entry in entries.items() for text in documentation.for_part(name, entry, kernel, llm)]
    told = instructions(kernel, examples=list(dict.fromkeys(examples)), snippets=list(dict.fromkeys(snippets)))
    asked = "\n\n".join(["The specifications:", *(f"## {name}\n\n{entry}" for name, entry in entries.items())])
    several = f"{told}\n\n{prompt('part_group', count=str(len(entries)))}"
    reply = llm.complete(Request(ROLE, step, (system(several), user(asked))))
    return {name: Answer(step, text) for name, text in sections(reply.text, tuple(entries)).items()}


def sections(text: str, names: Sequence[str]) -> dict[str, str]:
    """Return what an answer says of each part: what follows its heading, up to the next heading of a part; no line of a script is one."""
    found: dict[str, str] = {}
    name, in_block = None, False
    for line in text.splitlines(keepends=True):
        if line.lstrip().startswith("```"):
            in_block = not in_block
        heading = None if in_block else _HEADING.fullmatch(line.strip())
        if heading is not None and heading[1] in names:
            name = heading[1]
            found[name] = ""
        elif name is not None:
            found[name] += line
    return found
