"""Design: from requirements to a plan that passes every check, before any geometry."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final

from articad.agents import excerpt, ranges
from articad.agents.llm import LLM, Image, Message, Request, assistant, system, user
from articad.agents.prompts import prompt, prompt_file
from articad.agents.replies import object_text, unusable
from articad.agents.requirements import Requirements, pictures_of
from articad.agents.retrieval import Memory, NoMemory, listed_cases
from articad.errors import OutputError, PlanError, ReadError
from articad.findings import Finding, Findings
from articad.plan.amending import amended
from articad.plan.remedies import advised
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import RunRequest

TRIES: Final = 5  # answers until a plan is valid; the findings of each go back to the model
SHOWN_FINDINGS: Final = 40  # more at once are not read; the next answer brings the rest
DOUBTS: Final = frozenset({"W_SCALE", "W_DENSITY", "W_DIMENSION_SIGN", "W_BORE_NARROW", "W_MOTION_RANGE"})
"""Codes of what is probably mistaken: asked about once each."""
ROLE: Final = "design"
ANALYSIS: Final = "Its analysis, made before there was a plan (where numbers differ, what the request states binds, then the plan):"
_TOOTHED: Final = re.compile(r"(?<![a-z])gear(?!box)|teeth|tooth|pinion|\bracks?\b|sprocket|\bcogs?\b", re.IGNORECASE)
_DIALECTS: Final = {
    "build123d": "The parts will be scripted in build123d.",
    "freecad": "The parts will be scripted in FreeCAD, as PartDesign features: boxes, cylinders, balls, and outlines of straight lines, circles and "
    "slots in planes across X, Y or Z that are padded, pocketed, revolved or lofted; patterns, fillets, chamfers. There is no ready "
    "function for a sweep, a helix or thread, an arc or spline in an outline, or a tilted plane: order shapes that do without.",
}
"""What a designer is told about the language of the part scripts, by kernel."""

Judged = tuple[AssemblyPlan | None, Findings, OutputError | None]
"""The plan of a reply, if it could be read; the findings about it; and the problem if it is not even JSON."""

Tell = Callable[[AssemblyPlan | None, Findings], None]
"""Called with each answer: the plan, if it could be read, and its findings."""


def response_schema(*, changes: bool = False) -> dict[str, Any]:
    """Return the JSON schema of a reply: the plan's top level only.

    Providers differ in the depth and the unions that they accept; the prompt describes the whole form, and `check_plan` checks it.

    Args:
        changes: Whether changes to a plan are accepted in place of a whole one.
    """
    text, items = {"type": "string"}, {"type": "array", "items": {"type": "object"}}
    properties = {
        "schema": {"type": "string", "enum": ["articad.plan/1"]},
        "name": text,
        "description": text,
        "ground": text,
        "freedoms": {"type": "integer"},
        "tree": {"type": "boolean"},
        **dict.fromkeys(("parameters", "materials", "parts", "joints", "couplings", "allow"), items),
        "assumptions": {"type": "array", "items": text},
    }
    if changes:
        return {"type": "object", "properties": {**properties, "changes": {"type": "object"}}}
    return {
        "type": "object",
        "properties": properties,
        "required": ["schema", "name", "ground", "freedoms", "materials", "parts", "joints"],
    }


class Designer:
    """Designs one product: the first plan, and new versions of it when geometry shows faults.

    Args:
        request: What the user asked for.
        requirements: The analysis of the request.
        llm: The model that designs.
        tries: Answers within which a plan must be valid.
        tell: Called with each answer.
        memory: Cases of earlier runs.
        instructions: The system prompt; by default the design prompt.
        judge: Function that reads an answer and its step.
    """

    def __init__(
        self,
        request: RunRequest,
        requirements: Requirements,
        llm: LLM,
        *,
        tries: int = TRIES,
        tell: Tell | None = None,
        memory: Memory | None = None,
        instructions: str | None = None,
        judge: Callable[[str, str], Judged] | None = None,
    ) -> None:
        self._llm = llm
        self._judge = judge or judged
        self._tries = tries
        self._tell = tell or (lambda _plan, _findings: None)
        self._answered = 0
        self._said = ""  # the last plan, whole, as JSON
        self._unseen: Sequence[str] = ()  # parts whose orders the last request left out
        self._doubted: set[tuple[str, str]] = set()
        self._request, self._requirements, self._own_rules = request, requirements, instructions is not None
        self._aids = _dialect(request) + _recipe(request, requirements)
        words = task(request, requirements) + self._aids + _recalled(memory or NoMemory(), request, requirements)
        self._opening = (system(instructions or _instructions()), user(words, *pictures_of(request)))

    def first(self) -> AssemblyPlan:
        """Return a plan without errors.

        Raises:
            PlanError: If the last answer still has errors; `findings` holds them.
            OutputError: If the last answer is not a plan at all.
        """
        return self._until_valid(self._opening)

    def again(
        self, plan: AssemblyPlan, findings: Iterable[Finding], *, pictures: Sequence[Image] = (), stubborn: Iterable[Finding] = ()
    ) -> AssemblyPlan:
        """Return another plan, after the parts of this one were built and findings resulted.

        Args:
            plan: The plan that was built.
            findings: The findings to resolve.
            pictures: Pictures of the places of the findings.
            stubborn: Findings that came back although the plan was changed for them.

        Raises:
            PlanError, OutputError: As `first`.
        """
        came_back = listed(stubborn)
        note = (
            f" These came back although you changed the plan for them; solve them in another way this time:\n\n{came_back}\n\n"
            if came_back
            else ""
        )
        every = tuple(findings)
        words = prompt("redesign", findings=listed(every), note=note)
        if pictures:
            words += "\n\nPictures of the places follow; what parts have in common is red."
        self._doubted.update(map(_place, every))
        self._said = self._whole(plan)
        return self._until_valid(self._to_change(every, words, *pictures, anew=bool(came_back)))

    def _whole(self, plan: AssemblyPlan) -> str:
        """Return a plan as its author wrote it, or as it is if it has changed since: fine-tuned connectors stay."""
        if not self._said or self._judge(self._said, ROLE)[0] != plan:
            self._said = plan.dumps()
        return self._said

    def _to_change(self, findings: Sequence[Finding], complaint: str, *pictures: Image, anew: bool = False) -> tuple[Message, ...]:
        """Return the request for changes to the last plan: with what bears on the findings, or with everything, for another solution."""
        self._unseen = ()
        if anew or self._own_rules:
            return (*self._opening, assistant(self._said), user(complaint, *pictures))
        plan, fields = json.loads(self._said), None
        if not excerpt.is_of_model(findings):
            plan, self._unseen = excerpt.excerpt(plan, excerpt.concerned(plan, findings))
            fields = excerpt.STATED
        if self._unseen:
            complaint += (
                f"\n\nIn the plan above the {', '.join(excerpt.ORDERS)} of {', '.join(self._unseen)} are left out. They stay as they are; "
                "where one must change, write the whole of it."
            )
        aids = "" if all(finding.stage == "plan" for finding in findings) else self._aids
        told = system(prompt("design_change", rules=excerpt.rules(findings)))
        stated = user(task(self._request, self._requirements, fields=fields) + aids, *pictures_of(self._request))
        return (told, stated, assistant(excerpt.compact(plan)), user(complaint, *pictures))

    def _until_valid(self, messages: tuple[Message, ...]) -> AssemblyPlan:
        before: object = None
        asked = messages
        alike = 0
        for number in range(1, self._tries + 1):
            self._answered += 1
            step = f"design/{self._answered}"
            reply = self._llm.complete(Request(ROLE, step, messages, response_schema(changes=bool(self._said))))
            plan, findings, problem = self._read(reply.text, step)
            if plan is not None and findings.ok and not self._own_rules:
                findings += ranges.planned(resolve(plan), self._requirements.motions)
            self._tell(plan, findings)
            if plan is not None and findings.ok:
                doubts = [finding for finding in findings if finding.code in DOUBTS and _place(finding) not in self._doubted]
                if not doubts or number == self._tries:
                    return plan
                self._doubted.update(map(_place, doubts))
                messages = asked = self._to_change(doubts, prompt("design_doubts", findings=listed(doubts)))
                continue
            now = None if problem else tuple((finding.code, finding.where, finding.message) for finding in findings.errors)
            alike = alike + 1 if now is not None and now == before else 0
            before = now
            if number == self._tries or alike > 1:
                stalled = "" if number == self._tries else " The same findings came back every time."
                raise problem or PlanError(f"No valid plan in {number} answers.{stalled}\n{findings}", findings=findings)
            if problem:
                messages = (*asked, assistant(reply.text), user(prompt("form_repair", problem=problem.message)))
            else:
                complaint = prompt("design_anew" if alike else "design_repair", findings=listed(findings))
                messages = asked = self._to_change(tuple(findings), complaint, anew=alike > 0)
        raise AssertionError("the last try either returns or raises")

    def _read(self, text: str, step: str) -> Judged:
        """Return what a reply states, a whole plan or changes to the last one; `_said` becomes the whole plan."""
        try:
            whole = object_text(text, step=step)
            changes = changes_of(json.loads(whole))
            if changes is not None:
                if not self._said:
                    raise unusable("it has changes, but there is no plan yet; answer with the whole plan.", text, step=step)
                plan = json.loads(self._said)
                changes = excerpt.with_orders(changes, plan, self._unseen)
                whole, changes = json.dumps(amended(plan, changes), indent=1, ensure_ascii=False), None
        except OutputError as error:
            return None, error.findings, error
        except ReadError as error:
            problem = unusable(f"its changes do not fit the plan: {error.message}", text, step=step)
            return None, problem.findings, problem
        if changes is None:
            self._said = whole
        return self._judge(whole, step)


def changes_of(answer: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return the changes by address, if an answer has those instead of a whole plan."""
    changes = answer.get("changes")
    return changes if isinstance(changes, dict) and "parts" not in answer else None


def _place(finding: Finding) -> tuple[str, str]:
    return finding.code, finding.where


def listed(findings: Iterable[Finding]) -> str:
    """Return findings as a list for a prompt: what is wrong, where, and what would be valid."""
    several = tuple(findings)
    lines = [f"- {finding}" for finding in several[:SHOWN_FINDINGS]]
    if len(several) > SHOWN_FINDINGS:
        lines.append(f"- … and {len(several) - SHOWN_FINDINGS} more, likely of the same causes.")
    return "\n".join(lines)


def judged(text: str, step: str) -> Judged:
    """Return the plan of a reply, its findings, and the problem if it is not even JSON."""
    try:
        plan = AssemblyPlan.loads(object_text(text, step=step))
    except OutputError as error:
        return None, error.findings, error
    except PlanError as error:
        return None, error.findings, None
    return plan, advised(plan), None


def _instructions() -> str:
    return prompt("design", example=excerpt.compact(json.loads(prompt_file("sewing_box.json"))))


def task(request: RunRequest, requirements: Requirements, *, fields: Sequence[str] | None = None) -> str:
    """Return a request and its analysis as text; of the analysis all or some fields."""
    words = request.prompt.strip() or "(no words; see the pictures)"
    return f"The customer's request:\n\n{words}\n\n{ANALYSIS}\n\n{requirements.told(fields)}"


def _dialect(request: RunRequest) -> str:
    """Return the text about the script language and its limits."""
    told = _DIALECTS.get(str(request.options.get("kernel")))
    return "" if told is None else f"\n\n{told}"


def _recipe(request: RunRequest, requirements: Requirements) -> str:
    """Return how to order teeth, where the product may have some."""
    return f"\n\n{prompt('teeth')}" if _TOOTHED.search(f"{request.prompt}\n{requirements.told()}") else ""


def _recalled(memory: Memory, request: RunRequest, requirements: Requirements) -> str:
    """Return the text of cases from earlier runs; empty if there are none."""
    recalled = memory.for_design(request.prompt, requirements)
    return listed_cases("Of earlier products that turned out well:", recalled.heuristics) + listed_cases(
        "Defects of earlier products, to be avoided:", recalled.constraints
    )
