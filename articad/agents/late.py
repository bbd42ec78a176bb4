"""Late: the paper's ablation in which connections are planned only after the parts exist.

The designer lists parts without connectors and joints, and each is modelled by itself. Then one agent reads their scripts and shapes and
adds connectors and joints. The rest is the full pipeline.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from pydantic import Field

from articad.agents.design import Designer, Judged, judged, listed, task
from articad.agents.excerpt import compact
from articad.agents.line import Line, PlanAuthor
from articad.agents.llm import Image, Message, Request, assistant, system, user
from articad.agents.numbers import listed_numbers, short
from articad.agents.part_builder import PartsError
from articad.agents.pictures import part_picture
from articad.agents.prompts import prompt, prompt_file, prompt_section
from articad.agents.replies import ReplyForm, reader, schema_of
from articad.agents.requirements import Requirements, pictures_of
from articad.aliases import Json
from articad.errors import OutputError, PlanError
from articad.findings import Finding, Findings
from articad.kernels.parts import RealisedPart
from articad.plan.check import check_plan
from articad.plan.entry import specification
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan, PartSpec

ROLE: Final = "connect"
PICTURES: Final = 8  # parts whose pictures one agent gets at once
ENDING: Final = b"""

def build(part, _geometry=build):  # connectors are where the plan, made after this part, has them
    shape, _ = _geometry(part)
    return shape, {name: {"o": c.o, "z": c.z, "x": c.x} for name, c in part.connectors.items()}
"""
_JOINING: Final = ("joints", "couplings", "allow")
_LATER: Final = {"E_DISCONNECTED", "E_NO_CONNECTORS", "E_DOF_MISMATCH"}  # findings that a plan without joints must have


class LateLine(Line):
    """The pipeline of a run whose connections are planned late."""

    def planner(self, requirements: Requirements) -> PlanAuthor:
        """Return who lists the parts, has them made and connects them."""
        self.builder.ending = ENDING
        self.builder.announce("design", "started")
        return LatePlanner(self, requirements)


class Connections(ReplyForm):
    """An agent's answer: where parts connect, and how."""

    connectors: dict[str, tuple[Json, ...]]
    joints: tuple[Json, ...]
    couplings: tuple[Json, ...] = ()
    allow: tuple[Json, ...] = ()
    rest_poses: dict[str, Json | str] = Field(default_factory=dict)
    freedoms: int
    tree: bool = False


class LatePlanner:
    """Makes plans from parts that already exist.

    Args:
        line: The run in progress.
        requirements: The analysis of the request.
    """

    def __init__(self, line: Line, requirements: Requirements) -> None:
        self._line, self._requirements, self._builder = line, requirements, line.builder
        self._tries = int(line.options["designs"])
        self._connected = 0
        self._said = ""
        self._parts: AssemblyPlan | None = None
        self._alone: dict[str, ResolvedPlan] = {}  # by part, the plan for which its script was written
        self._designer = Designer(
            line.run.request,
            requirements,
            line.port,
            tries=self._tries,
            tell=line.tell_of_plan,
            memory=line.memory,
            instructions=prompt("design_late", rules=prompt_section("design.md", "# 1. Units", "# 4. Connectors"), example=_example()),
            judge=_judged,
        )

    def first(self) -> AssemblyPlan:
        """Return a plan of parts that are made.

        Raises:
            PlanError, OutputError: If no answer is valid.
            PartsError: If parts cannot be made in any round.
        """
        return self._joined(self._designer.first(), ())

    def again(
        self, plan: AssemblyPlan, findings: Iterable[Finding], *, pictures: Sequence[Image] = (), stubborn: Iterable[Finding] = ()
    ) -> AssemblyPlan:
        """Return another plan: the parts are listed again, and connected again; see `Designer.again`."""
        several = tuple(findings)
        parts = self._designer.again(self._parts or plan, several, pictures=pictures, stubborn=stubborn)
        return self._joined(parts, several)

    # ------------------------------------------------------------------ parts first

    def _joined(self, parts: AssemblyPlan, findings: Sequence[Finding]) -> AssemblyPlan:
        for number in range(1, self._line.rounds + 1):
            self._parts = parts
            alone = {part.name: resolve(_alone(parts, part.name)) for part in parts.parts if isinstance(part, PartSpec)}
            self._builder.adopt(self._alone, {name: script for name, script in self._builder.scripts.items() if name in self._alone})
            self._alone = alone
            try:
                self._builder.make(alone, self._builder.planned)
            except PartsError as failed:
                if number == self._line.rounds:
                    raise
                parts = self._designer.again(parts, failed.for_design)
                continue
            break
        fates = dict(self._builder.fates)
        plan = self._connections(parts, self._builder.alone(alone), findings)
        self._builder.adopt(dict.fromkeys(alone, resolve(plan)), self._builder.scripts, fates)
        return plan

    # ------------------------------------------------------------------ then what joins them

    def _connections(self, parts: AssemblyPlan, made: Mapping[str, RealisedPart], findings: Sequence[Finding]) -> AssemblyPlan:
        self._builder.announce("connect", "started")
        opening = self._opening(parts, made)
        messages = opening
        if findings and self._said:
            messages = (*opening, assistant(self._said), user(prompt("connect_again", findings=listed(findings))))
        for number in range(1, self._tries + 1):
            self._connected += 1
            step = f"connect/{self._connected}"
            reply = self._line.port.complete(Request(ROLE, step, messages, schema_of(Connections)))
            self._said = reply.text
            plan, found, problem = _connected(parts, reply.text, step)
            self._line.tell_of_plan(plan, found)
            if plan is not None and found.ok:
                return plan
            if number == self._tries:
                raise problem or PlanError(f"No valid connections in {number} answers.\n{found}", findings=found)
            complaint = prompt("form_repair", problem=problem.message) if problem else prompt("connect_repair", findings=listed(found))
            messages = (*opening, assistant(reply.text), user(complaint))
        raise AssertionError("the last try either returns or raises")

    def _opening(self, parts: AssemblyPlan, made: Mapping[str, RealisedPart]) -> tuple[Message, ...]:
        request = self._line.run.request
        words = [
            task(request, self._requirements),
            f"The plan of its parts:\n\n```json\n{parts.dumps()}```",
            "The parts as they were made:",
        ]
        words += [_told(name, part, resolve(_alone(parts, name)), self._builder.shown(name)) for name, part in made.items()]
        shown: list[str | Image] = ["\n\n".join(words), *pictures_of(request)]
        if self._line.options.get("look"):
            for name, part in list(made.items())[:PICTURES]:
                shown += [f"Part {name}:", part_picture(part.part, part.digests["build"])]
        rules = prompt_section("design.md", "# 1. Units", "# 7. Example")
        return (system(prompt("connect", rules=rules)), user(*shown))


def _told(name: str, part: RealisedPart, resolved: ResolvedPlan, script: str) -> str:
    """Return the text about a part that was made."""
    solid = part.built.solid
    measured = (
        f"Measured, in its own frame: from {listed_numbers(solid.bbox[0])} to {listed_numbers(solid.bbox[1])} mm, "
        f"volume {short(solid.volume)} mm³, centre of mass {listed_numbers(solid.com)}."
    )
    return f"Part {name}. Its entry:\n\n{specification(resolved, name)}\n\n{measured}\n\nIts script:\n\n{script}"


def _connected(parts: AssemblyPlan, text: str, step: str) -> Judged:
    """Return the plan that an answer completes, its findings, and the problem if it does not have the form."""
    try:
        answer = reader(Connections)(text, step)
    except OutputError as error:
        return None, error.findings, error
    document: Json = json.loads(parts.dumps())
    known = {entry["name"]: entry for entry in document["parts"]}
    strangers = sorted({*answer.connectors, *answer.rest_poses} - {name for name, entry in known.items() if "derive" not in entry})
    if strangers:
        message = f"{', '.join(strangers)} is not a part with its own connectors."
        hint = f"There are {', '.join(name for name, entry in known.items() if 'derive' not in entry)}; copies have those of their source."
        return None, Findings([Finding(code="E_SCHEMA", where="connectors", message=message, hint=hint)]), None
    for name, connectors in answer.connectors.items():
        known[name]["connectors"] = list(connectors)
    for name, pose in answer.rest_poses.items():
        known[name]["rest_pose"] = pose
    document |= {field: list(getattr(answer, field)) for field in _JOINING} | {"freedoms": answer.freedoms, "tree": answer.tree}
    try:
        plan = AssemblyPlan.from_json(document)
    except PlanError as error:
        return None, error.findings, None
    return plan, check_plan(plan), None


def _judged(text: str, step: str) -> Judged:
    """Return the list of parts in an answer, without its connections, and its findings."""
    plan, findings, problem = judged(text, step)
    if plan is None:
        return plan, findings, problem
    document = _bare(json.loads(plan.dumps()))
    plan = AssemblyPlan.from_json(document)
    found = [finding for finding in check_plan(plan) if finding.code not in _LATER]
    for part in plan.parts:
        if isinstance(part, PartSpec) and part.rest_pose == "auto":
            hint = "Give its position at rest."
            found.append(Finding(code="E_SCHEMA", where=f"parts.{part.name}.rest_pose", message="No joint places it yet.", hint=hint))
    return plan, Findings(found), None


def _bare(document: Json) -> Json:
    """Return a plan's JSON without connections."""
    parts = [{field: value for field, value in part.items() if field != "connectors"} for part in document["parts"]]
    kept = {field: value for field, value in document.items() if field not in {*_JOINING, "tree"}}
    return kept | {"parts": parts, "joints": [], "freedoms": 0}


def _alone(plan: AssemblyPlan, name: str) -> AssemblyPlan:
    """Return the plan of one part by itself."""
    document = _bare(json.loads(plan.dumps()))
    part = next(entry for entry in document["parts"] if entry["name"] == name)
    return AssemblyPlan.from_json(document | {"parts": [part], "ground": name})


def _example() -> str:
    document = _bare(json.loads(prompt_file("sewing_box.json")))
    return compact(AssemblyPlan.from_json(document).to_json())
