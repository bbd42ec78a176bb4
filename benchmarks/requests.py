"""What runs asked of models: requests, characters and pictures, by role and by section of the prompt.

    python benchmarks/requests.py [RUN ...]
    python benchmarks/requests.py --again

By default the 22 recorded runs, as they were asked when they were recorded. Characters are those of the text of all messages; schemas and
pictures are counted by themselves. A section is a stretch of a prompt that begins with a title of its own.

With --again, eight recorded products are made again with the present prompts and options, and what is asked for them is compared with what
was asked when they were recorded. They are answered as recorded, but for a slip in five plans and in two scripts, each of which a further request mends:
in a trial a model made as many. Exit code 1 if fewer than 40 % of the characters are saved.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

from articad.agents.llm import Reply, Request
from articad.agents.pipeline import generate
from articad.agents.settings import RunOptions, Services
from articad.kernels.choice import kernel_named
from articad.plan.expressions import FUNCTIONS
from articad.runs.run import Run

ROOT: Final = Path(__file__).resolve().parents[1]
RECORDED: Final = ("tests/recordings/*/llm", "tests/recordings/asked/*/llm", "examples/*/recording/llm")
_SECTIONS: Final = {
    "cases, for a part": r"# Parts of other products that were built well.*?(?=\n# From the documentation|\Z)",
    "cases, for a design": r"(?:Of earlier products that turned out well|Defects of earlier products).*\Z",
    "documentation": r"# From the documentation.*\Z",
    "analysis": r"Its analysis, made before[^\n]*\n\n.*?(?=\n\n|\Z)|```json\n\{\s*\"name\".*?\n```",
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


# ---------------------------------------------------------------------- products asked for again

Plan = dict[str, Any]
AGAIN: Final = (
    "examples/sewing_things_box/recording",
    "tests/recordings/asked/gripper",
    "tests/recordings/asked/hand_press",
    "tests/recordings/asked/pumpjack",
    "tests/recordings/asked/table_football",
    "tests/recordings/mirrored",
    "tests/recordings/toaster",
    "tests/recordings/whisk",
)
GOAL: Final = 0.4  # of the characters, saved


def _named_like_a_function(plan: Plan) -> Plan:
    """Give the first parameter the name of a function."""
    old = plan["parameters"][0]["name"]
    new = next(name for name in ("floor", *FUNCTIONS) if name in FUNCTIONS)
    numbers = {
        "value",
        "min",
        "max",
        "o",
        "dimensions",
        "envelope_mm",
        "at",
        "about",
        "angle_deg",
        "travel_mm",
        "rest_mm",
        "rest_deg",
        "point",
    }

    def renamed(value: Any, *, number: bool = False) -> Any:
        if isinstance(value, dict):
            return {key: renamed(entry, number=number or key in numbers) for key, entry in value.items()}
        if isinstance(value, list):
            return [renamed(entry, number=number) for entry in value]
        return re.sub(rf"\b{old}\b", new, value) if number and isinstance(value, str) else value

    changed: Plan = renamed(plan)
    changed["parameters"][0]["name"] = new
    return changed


def _too_long(plan: Plan) -> Plan:
    """Write a dimension of the first part as an expression of more than 200 characters."""
    dimensions = next(part["dimensions"] for part in plan["parts"] if part.get("dimensions"))
    name, value = next(iter(dimensions.items()))
    dimensions[name] = f"{value}" + " + 0.125 - 0.125" * 20
    return plan


def _of_a_dimension(plan: Plan) -> Plan:
    """Write the origin of a connector in a name that is a dimension of its part and no parameter."""
    known = {entry["name"] for entry in plan["parameters"]}
    for part in plan["parts"]:
        own = [name for name in part.get("dimensions", {}) if name not in known]
        if own:
            part["connectors"][0]["o"][0] = own[0]
            return plan
    return _too_long(plan)


SLIPS: Final[dict[str, Callable[[Plan], Plan]]] = {  # by the last name of a recording, what is wrong with its first plan
    "gripper": _named_like_a_function,
    "hand_press": _of_a_dimension,
    "pumpjack": _too_long,
    "table_football": _named_like_a_function,
    "whisk": _of_a_dimension,
}
UNKNOWN_DIMENSION: Final = ("mirrored", "toaster")  # recordings whose first script reads a dimension that its part does not have


class AsRecorded:
    """Answers as a recording does, scripts of several parts together, a first plan or script with its slip; keeps what it was asked.

    Args:
        recording: The run.
        name: Its name in `SLIPS` and `UNKNOWN_DIMENSION`.
    """

    def __init__(self, recording: Run, name: str) -> None:
        self._run, self._slip, self._misread = recording, SLIPS.get(name), name in UNKNOWN_DIMENSION
        self.requests: list[Request] = []

    def complete(self, request: Request) -> Reply:
        """Answer a request."""
        self.requests.append(request)
        return Reply(self._answer(request), "recorded")

    def _answer(self, request: Request) -> str:
        role, *address = request.step.split("/")
        if role == "design" and self._slip is not None:
            plan = json.loads(self._said("design/1").strip().removeprefix("```json").removesuffix("```"))
            return json.dumps(self._slip(plan) if address == ["1"] else plan, indent=1)
        if role == "parts":
            names = re.findall(r"^## (\w+)$", _words(request), re.MULTILINE)
            scripts = [self._said(f"part/{name}/1") for name in names]
            if self._misread and address[1] == "1":
                scripts[0] = re.sub(r"(def build\(part\):\n)( +)", r"\1\2part.dimensions['size']\n\2", scripts[0], count=1)
            return "\n\n".join(f"## {name}\n\n{script}" for name, script in zip(names, scripts, strict=True))
        if role == "survey":
            return _surveyed(request)
        step = f"{role}/{address[0]}/1" if role in {"part", "look"} else request.step
        if role in {"part", "look"} or self._run.reply(step) is not None:
            return self._said(step)
        if role == "observe":  # the recording had no inspector: one agrees
            moving = [
                {"joint": name, "seen": "moves", "expected": True} for name in re.findall(r"Keyframes of joint (\w+)", _words(request))
            ]
            return json.dumps({"overall": "as asked for", "parts": [], "motions": moving})
        agreed = {"ok": True, "reason": "as asked for"}
        return json.dumps(dict.fromkeys(("placement", "interference", "motion"), agreed) | {"problems": []})

    def _said(self, step: str) -> str:
        stored = self._run.reply(step)
        if stored is None:
            raise KeyError(f"{self._run.path} has no answer to {step}.")
        return Reply.from_json(stored["reply"]).text


def _surveyed(request: Request) -> str:
    """Answer as whoever looked at the recorded parts did: all are as ordered."""
    agreed = {"seen": "as ordered", "agrees": True, "fault": "none", "wrong": "", "remedy": ""}
    return json.dumps({"parts": [{"part": name} | agreed for name in re.findall(r"^## (\w+)$", _words(request), re.MULTILINE)]})


def _words(request: Request) -> str:
    return "\n".join(part["text"] for message in request.to_json()["messages"] for part in message["content"] if part["type"] == "text")


def asked_again(recording: Path, out: Path) -> list[Request]:
    """Make a recorded product again with the present prompts and options; return what was asked.

    Args:
        recording: The recorded run.
        out: Directory of the new run.

    Raises:
        ArticadError: If the product is not made.
    """
    run = Run.view(recording)
    options = run.request.options
    model = AsRecorded(run, recording.name)
    ideas = "always" if options["ideas"] == "always" else "auto"
    services = Services(kernel=kernel_named(options["kernel"]))
    generate(run.prompt, llm=model, out=out, options=RunOptions(formats=(), ideas=ideas, variant=options["variant"]), services=services)
    return model.requests


def again() -> int:
    """Print what is asked for the eight products now, and what was asked when they were recorded; return the exit code."""
    told: Counter[tuple[str, str]] = Counter()
    numbers: Counter[tuple[str, str]] = Counter()
    before: Counter[tuple[str, str]] = Counter()
    for name in AGAIN:
        for file in sorted((ROOT / name / "llm").glob("*.json")):
            counted(json.loads(file.read_text(encoding="utf-8")), Counter(), before)
        with tempfile.TemporaryDirectory() as scratch:
            requests = asked_again(ROOT / name, Path(scratch) / "run")
        for request in requests:
            counted(request.to_json(), told, numbers)
        print(f"{name}: {len(requests)} requests", flush=True)
    print()
    listed(told, numbers)
    now, then = ({what: _sum(of, what) for what in ("requests", "characters")} for of in (numbers, before))
    saved = {what: 1 - now[what] / then[what] for what in now}
    print(f"recorded: {then['requests']} requests, {then['characters']} characters")
    print(
        f"again: {now['requests']} requests ({saved['requests']:.0%} saved), {now['characters']} characters ({saved['characters']:.1%} saved)"
    )
    return int(saved["characters"] < GOAL)


def _sum(numbers: Counter[tuple[str, str]], what: str) -> int:
    return sum(number for (_, kind), number in numbers.items() if kind == what)


def listed(told: Counter[tuple[str, str]], numbers: Counter[tuple[str, str]]) -> None:
    """Print a line for each role, and its sections below it."""
    whole = max(_sum(numbers, "characters"), 1)
    for role in sorted({role for role, _ in numbers}, key=lambda role: -numbers[role, "characters"]):
        own = {what: numbers[role, what] for what in ("requests", "characters", "pictures", "schema")}
        print(
            f"{role:<14}{own['requests']:>5} requests {own['characters']:>9} characters {own['pictures']:>5} pictures, schema {own['schema']}"
        )
        for (_, name), length in sorted(((key, n) for key, n in told.items() if key[0] == role), key=lambda item: -item[1]):
            print(f"    {name:<26}{length:>9} {length / whole:>6.1%}")


def main() -> int:
    """Print a line for each role, its sections below it, and the sums."""
    if sys.argv[1:] == ["--again"]:
        return again()
    runs = [Path(name) / "llm" for name in sys.argv[1:]] or sorted(folder for pattern in RECORDED for folder in ROOT.glob(pattern))
    told: Counter[tuple[str, str]] = Counter()
    numbers: Counter[tuple[str, str]] = Counter()
    for run in runs:
        for file in sorted(run.glob("*.json")):
            counted(json.loads(file.read_text(encoding="utf-8")), told, numbers)
    listed(told, numbers)
    requests, characters, pictures = (_sum(numbers, what) for what in ("requests", "characters", "pictures"))
    print(f"{len(runs)} runs: {requests} requests, {characters} characters, {pictures} pictures")
    return 0


if __name__ == "__main__":
    sys.exit(main())
