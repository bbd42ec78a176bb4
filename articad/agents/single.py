"""Single loop: the paper's baseline. One model writes one script that makes and assembles all parts; if it fails to run, it goes back.

There is no plan, no contract, no inspection and no memory: only the loop of writing, running and repairing. The finished assembly is
measured and reported like that of any other run.
"""

from __future__ import annotations

import ast
import json
from typing import Final

from pydantic import ValidationError

from articad.agents.evidence import Evidence
from articad.agents.late import ENDING
from articad.agents.line import Line
from articad.agents.llm import Message, Request, assistant, closed_port, system, user
from articad.agents.part_writer import failure_text
from articad.agents.prompts import prompt, prompt_section
from articad.agents.replies import ReplyForm, parse_script, unusable
from articad.agents.requirements import pictures_of
from articad.aliases import Json
from articad.assembly import Assembly
from articad.errors import KernelError, OutputError, PlanError
from articad.findings import Findings
from articad.plan.check import check_plan
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.record import record_assembly, record_checks

ROLE: Final = "single"
RETRIES: Final = 5  # the paper's
NAME: Final = "ASSEMBLY"
_API: Final = {"build123d": ("# build123d in brief", "# Example"), "freecad": ("# What you work with", "# Example")}
_PLAIN: Final = {"name": "plain", "density_kg_m3": 1000, "color": "#b8b8b8"}


class ScriptPart(ReplyForm):
    """A part of the script's assembly."""

    name: str
    material: str = "plain"
    description: str = ""


class Whole(ReplyForm):
    """What the script says of the assembly."""

    name: str
    ground: str
    parts: tuple[ScriptPart, ...]
    joints: tuple[Json, ...] = ()
    couplings: tuple[Json, ...] = ()
    materials: tuple[Json, ...] = ()


class SingleLine(Line):
    """The pipeline of the baseline: one step, repeated until it runs."""

    def work(self) -> None:
        """Ask for the script until it runs, then measure and export its assembly.

        Raises:
            OutputError, PlanError, KernelError: The failure of the last answer.
        """
        self.builder.announce("design", "started")
        assembly = self._written()
        with closed_port("assembly and checks are deterministic"):
            record_assembly(self.run, assembly)
            evidence: Evidence = self.examined(assembly)
            record_checks(self.run, evidence.checks)
        self.builder.announce("check", "ok" if evidence.ok else f"{len(evidence.findings.errors)} errors")
        self.finish(assembly, evidence, None)

    def _written(self) -> Assembly:
        request, kernel = self.run.request, self.builder.kernel.name
        words = f"The request:\n\n{request.prompt.strip() or '(no words; see the pictures)'}"
        api = prompt_section(f"part_{kernel}.md", *_API[kernel])
        shape = "`part.body`" if kernel == "freecad" else "a solid"
        opening = (system(prompt("single", kernel=kernel, api=api, shape=shape)), user(words, *pictures_of(request)))
        messages: tuple[Message, ...] = opening
        for number in range(1, RETRIES + 2):
            step = f"script/{number}"
            reply = self.port.complete(Request(ROLE, step, messages))
            try:
                return self._made(reply.text, step)
            except (OutputError, PlanError, KernelError) as error:
                for finding in error.findings:
                    self.run.trace_finding(finding)
                self.builder.announce("script", f"{len(error.findings)} errors")
                if number > RETRIES:
                    raise
                messages = (*opening, assistant(reply.text), user(prompt("part_repair", failure=_failure(error))))
        raise AssertionError("the last try either returns or raises")

    def _made(self, text: str, step: str) -> Assembly:
        script = parse_script(text, step=step)
        plan = _plan(_whole(script, text, step), self.builder.kernel.name)
        resolved = resolve(plan)
        sources = [name for name, part in resolved.parts.items() if part.derivation is None]
        self.builder.made.clear()
        self.builder.adopt(dict.fromkeys(sources, resolved), dict.fromkeys(sources, script + ENDING))
        with closed_port("assembly is deterministic"):
            _, assembly = self.builder.joined(plan, resolved)
        self.run.save_plan(plan.dumps(), 0)
        return assembly


def _whole(script: bytes, text: str, step: str) -> Whole:
    """Return what a script states about the assembly; it is parsed, never run."""
    try:
        tree = ast.parse(script)
        values = [node.value for node in tree.body if isinstance(node, ast.Assign) and [ast.unparse(one) for one in node.targets] == [NAME]]
        return Whole.model_validate(ast.literal_eval(values[-1]))
    except SyntaxError as error:
        raise unusable(f"it is not Python: {error.msg} in line {error.lineno}.", text, step=step) from None
    except IndexError:
        raise unusable(f"it does not define {NAME}.", text, step=step) from None
    except ValidationError as error:
        problems = [f"{'.'.join(map(str, detail['loc']))}: {detail['msg']}" for detail in error.errors()]
        raise unusable(f"{NAME} does not have the required form: {'; '.join(problems)}.", text, step=step) from None
    except (ValueError, TypeError, RecursionError, MemoryError):
        raise unusable(f"{NAME} is not a plain literal: write numbers and texts out.", text, step=step) from None


def _plan(whole: Whole, kernel: str) -> AssemblyPlan:
    """Return the plan of an assembly whose parts are all drawn in place.

    Raises:
        PlanError: If it is not valid.
    """
    parts: dict[str, Json] = {
        one.name: {"name": one.name, "material": one.material, "description": one.description or one.name, "connectors": []}
        for one in whole.parts
    }
    joints = []
    for stated in whole.joints:
        joint = dict(stated)
        frame = {"o": joint.pop("at", None), "z": joint.pop("axis", [0, 0, 1]), "x": joint.pop("zero", None), "label": "a joint"}
        for side in ("parent", "child"):
            part = str(joint.get(side))
            if part in parts:
                parts[part]["connectors"].append(
                    {"name": joint.get("name")} | {key: value for key, value in frame.items() if value is not None}
                )
            joint[side] = f"{part}.{joint.get('name')}"
        joints.append(joint)
    materials = [*whole.materials, *([] if any(one.get("name") == _PLAIN["name"] for one in whole.materials) else [_PLAIN])]
    document: Json = {"schema": "articad.plan/1", "name": whole.name, "ground": whole.ground, "freedoms": 0, "kernel": kernel}
    document |= {"materials": materials, "parts": list(parts.values()), "joints": joints, "couplings": list(whole.couplings)}
    plan = AssemblyPlan.from_json(json.loads(json.dumps(document)))
    findings = check_plan(plan)
    counted = findings.of("E_DOF_MISMATCH")
    if counted and counted[0].limit is not None:  # nobody declares freedoms here, so their number cannot be wrong
        plan = AssemblyPlan.from_json(json.loads(plan.dumps()) | {"freedoms": int(counted[0].limit)})
        findings = check_plan(plan)
    if not findings.ok:
        raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
    return plan


def _failure(error: OutputError | PlanError | KernelError) -> str:
    if isinstance(error, PlanError):
        return "\n".join(f"- {finding}" for finding in Findings(error.findings).errors)
    return failure_text(error)
