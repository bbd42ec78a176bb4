"""What runs asked of models: requests, characters and pictures, by role and by section of the prompt.

    python benchmarks/requests.py [RUN ...]

By default the 22 recorded runs, as they were asked when they were recorded. Characters are those of the text of all messages; schemas and
pictures are counted by themselves. A section is a stretch of a prompt that begins with a title of its own.
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
RECORDED: Final = ("tests/recordings/*/llm", "tests/recordings/asked/*/llm", "examples/*/recording/llm")
_SECTIONS: Final = {
    "cases, for a part": r"# Parts of other products that were built well.*?(?=\n# From the documentation|\Z)",
    "cases, for a design": r"(?:Of earlier products that turned out well|Defects of earlier products).*\Z",
    "documentation": r"# From the documentation.*\Z",
    "analysis": r"Its analysis, made before.*?\n```\n?(?=\n|\Z)|```json\n\{\s*\"name\".*?\n```",
    "observations": r"The observer saw:.*\Z",
    "measurements": r"Measured:\n.*\Z",
    "specification": r"The specification:\n.*\Z",
    "structure": r"Parts:\n- .*\Z",
}


def sections(text: str) -> Iterator[tuple[str, int]]:
    """Yield the sections of a message's text and their characters; what is in none is "instructions and request"."""
    for name, pattern in _SECTIONS.items():
        found = re.search(pattern, text, re.DOTALL)
        if found is not None:
            yield name, len(found[0])
            text = text[: found.start()] + text[found.end() :]
    yield "instructions and request", len(text)


def counted(request: dict[str, Any], told: Counter[tuple[str, str]], numbers: Counter[tuple[str, str]]) -> None:
    """Add a request to the characters by role and section, and to the numbers by role."""
    role = str(request["role"])
    numbers[role, "requests"] += 1
    schema = request.get("response_schema")
    numbers[role, "schema"] += len(json.dumps(schema)) if schema else 0
    for message in request["messages"]:
        for part in message["content"]:
            if part.get("type") != "text":
                numbers[role, "pictures"] += 1
                continue
            numbers[role, "characters"] += len(part["text"])
            for name, length in sections(part["text"]):
                told[role, name] += length


def main() -> int:
    """Print a line for each role, its sections below it, and the sums."""
    runs = [Path(name) / "llm" for name in sys.argv[1:]] or sorted(folder for pattern in RECORDED for folder in ROOT.glob(pattern))
    told: Counter[tuple[str, str]] = Counter()
    numbers: Counter[tuple[str, str]] = Counter()
    for run in runs:
        for file in sorted(run.glob("*.json")):
            counted(json.loads(file.read_text(encoding="utf-8")), told, numbers)
    whole = {what: sum(number for (_, kind), number in numbers.items() if kind == what) for what in ("requests", "characters", "pictures")}
    for role in sorted({role for role, _ in numbers}, key=lambda role: -numbers[role, "characters"]):
        own = {what: numbers[role, what] for what in ("requests", "characters", "pictures", "schema")}
        print(
            f"{role:<14}{own['requests']:>5} requests {own['characters']:>9} characters {own['pictures']:>5} pictures, schema {own['schema']}"
        )
        for (_, name), length in sorted(((key, n) for key, n in told.items() if key[0] == role), key=lambda item: -item[1]):
            print(f"    {name:<26}{length:>9} {length / max(whole['characters'], 1):>6.1%}")
    print(f"{len(runs)} runs: {whole['requests']} requests, {whole['characters']} characters, {whole['pictures']} pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main())
