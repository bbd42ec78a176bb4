"""The base of an edit: a finished run as it was. What stays the same can be proved, and need not be checked again."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, Self

from articad.agents.evidence import Known
from articad.agents.requirements import Component, Requirements
from articad.aliases import Json
from articad.assembly import Assembly
from articad.errors import ReadError
from articad.interference.report import PairCheck, Strength
from articad.kinematics.joints import Coupling, Joint
from articad.plan.amending import amended
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from articad.runs.run import Run, digest

Pair = tuple[str, str]

SCHEMA: Final = "articad.base/1"
_LISTS: Final = (
    "parameters",
    "materials",
    "parts",
    "joints",
    "couplings",
    "allow",
    "assumptions",
)  # lists of a plan; empty ones are left out
_SAME_MM, _SAME_RAD = 1e-9, 1e-12  # poses this close are the same pose, computed twice


@dataclass(frozen=True)
class Base:
    """A finished run, as the start of an edit.

    Attributes:
        stored: The document `articad.base/1`.
    """

    stored: Json

    @classmethod
    def of(cls, run: Run) -> Self:
        """Return the base made from a finished run.

        Raises:
            ReadError: If it is not finished.
        """
        text, checks = run.plan_text(), run.checks()
        if text is None or checks is None or run.assembly() is None:
            raise ReadError(f"{run.path} is not finished, so it cannot be edited: resume it first.", path=str(run.path))
        plan = AssemblyPlan.loads(text)
        given: Mapping[str, float] = run.request.options.get("parameters") or {}
        if given:  # a build with --set: the values that it was built with become the plan's own
            plan = with_values(plan, given)
        records = {name: run.part(name) or {} for name in run.part_names()}
        edited = run.base() or {}
        prompt = run.prompt if run.request.options.get("task") != "build" else plan.description
        return cls(
            {
                "schema": SCHEMA,
                "articad": run.version,
                "prompt": f"{edited['prompt']}\n\nChanged since: {prompt}" if edited else prompt,
                "task": run.request.options.get("task"),
                "kernel": str(run.request.options.get("kernel", plan.kernel)),
                "requirements": run.requirements(),
                "plan": plan.dumps(),
                "scripts": {name: script.decode() for name in records if (script := run.script(name)) is not None},
                "files": {name: run.part_files(name) for name in records},
                "digests": {name: record.get("digests", {}) for name, record in records.items()},
                "meshes": {name: record.get("shape", {}).get("mesh_sha256") for name, record in records.items()},
                "checks": checks,
            }
        )

    @property
    def mark(self) -> str:
        """The sha256 of the whole document."""
        return digest(self.stored)

    @cached_property
    def plan(self) -> AssemblyPlan:
        """The plan."""
        return AssemblyPlan.loads(self.stored["plan"])

    @cached_property
    def resolved(self) -> ResolvedPlan:
        """The plan with its numbers."""
        return resolve(self.plan)

    @property
    def scripts(self) -> dict[str, bytes]:
        """The scripts of its parts."""
        return {name: script.encode() for name, script in self.stored["scripts"].items()}

    @property
    def requirements(self) -> Requirements:
        """The requirements; for a run without a prompt, what its plan says of itself."""
        if self.stored["requirements"] is not None:
            return Requirements.model_validate(self.stored["requirements"])
        components = tuple(
            Component(name=name, count=1, description=part.role or part.description) for name, part in self.resolved.parts.items()
        )
        plain: Json = dict.fromkeys(("relations", "motions", "constraints", "dimensions", "assumptions"), ())
        return Requirements(name=self.plan.name, summary=self.plan.description or self.plan.name, components=components, **plain)

    # ------------------------------------------------------------------ what need not be checked again

    def known(self, assembly: Assembly, version: str) -> Known:
        """Return the verdicts that are also valid for the edited assembly.

        The verdict of a pair stays valid if both meshes, their relative pose at rest, and the joints between them with all joints
        coupled to these are unchanged; with closed loops, if all joints are unchanged. Only pairs without faults are carried over.

        Args:
            assembly: The edited assembly.
            version: Version of articad; verdicts of another version are not used.
        """
        if version != self.stored["articad"] or assembly.resolved is None:
            return Known()
        if dict(assembly.fits) != dict(self.resolved.fits) or assembly.waivers != self.resolved.waivers:
            return Known()
        scene = assembly.scene()
        built = {name: realised.built.solid.mesh.digest for name, realised in assembly.realised.items()}
        same = {name for name in scene.meshes if built.get(name) == self.stored["meshes"].get(name)}
        blamed = {frozenset(finding["parts"]) for finding in self.stored["checks"]["findings"]}
        rest: dict[Pair, PairCheck] = {}
        motion: dict[str, dict[Pair, PairCheck]] = {}
        order = {name: at for at, name in enumerate(scene.meshes)}
        for stored in self.stored["checks"]["pairs"]:
            pair = _pair(stored)
            if not same.issuperset(pair.parts) or frozenset(pair.parts) in blamed or pair.verdict not in {"clear", "contact"}:
                continue
            if (
                pair.strength.kind == "waived"
                or scene.relations.of(*pair.parts) != pair.relation
                or not self._held_alike(assembly, *pair.parts)
            ):
                continue
            if order[pair.parts[0]] > order[pair.parts[1]]:
                continue
            if pair.over == "rest":
                rest[pair.parts] = pair
            elif isinstance(pair.over, tuple) and self.stored["task"] != "build":  # a build samples in another way
                motion.setdefault(pair.over[0], {})[pair.parts] = pair
        joints = {joint.name for joint in assembly.joints if self._same_joint(joint)}
        return Known(rest, {joint: pairs for joint, pairs in motion.items() if joint in joints})

    def _held_alike(self, assembly: Assembly, a: str, b: str) -> bool:
        """Return whether two parts and their relative motion are unchanged."""
        before, after = self.resolved.mechanism, assembly.mechanism
        now, then = ({name: mechanism.rest_poses()[name] for name in (a, b)} for mechanism in (after, before))
        if not (now[a].inverse() @ now[b]).allclose(then[a].inverse() @ then[b], mm=_SAME_MM, rad=_SAME_RAD):
            return False
        if before.loop_joints or after.loop_joints:
            held, held_before = [joint.name for joint in after.joints], [joint.name for joint in before.joints]
        else:
            held, held_before = ([joint.name for joint in one.tree.joints_between(a, b)] for one in (after, before))
        moving = _tied(held, after.couplings)
        by_name = {joint.name: joint for joint in after.joints}
        return (
            held == held_before
            and moving == _tied(held_before, before.couplings)
            and [one for one in after.couplings if _ends(one) & moving] == [one for one in before.couplings if _ends(one) & moving]
            and all(self._same_joint(by_name[name]) for name in moving)
        )

    def _same_joint(self, joint: Joint) -> bool:
        """Return whether a joint is unchanged."""
        old = next((one for one in self.resolved.joints if one.name == joint.name), None)
        if old is None:
            return False
        frames = ("T_parent_connector", "T_child_connector")
        if not all(getattr(old, frame).allclose(getattr(joint, frame), mm=_SAME_MM, rad=_SAME_RAD) for frame in frames):
            return False
        return replace(joint, **{frame: getattr(old, frame) for frame in frames}) == old


def _ends(coupling: Coupling) -> set[str]:
    """Return the joints that a coupling connects; it names their columns."""
    return {column.split(".", maxsplit=1)[0] for column in (coupling.a, coupling.b)}


def _tied(joints: Iterable[str], couplings: Sequence[Coupling]) -> set[str]:
    """Return joints and all joints that move with them through couplings."""
    tied = set(joints)
    while more := {end for one in couplings if _ends(one) & tied for end in _ends(one)} - tied:
        tied |= more
    return tied


def document_of(plan: AssemblyPlan) -> Json:
    """Return a plan's JSON with all its lists, so that addresses into empty lists are valid too."""
    document: Json = json.loads(plan.dumps())
    return document | {name: document.get(name, []) for name in _LISTS}


def with_values(plan: AssemblyPlan, values: Mapping[str, float]) -> AssemblyPlan:
    """Return a plan whose parameters have these values.

    Raises:
        PlanError: If a parameter is unknown, or a value is outside its bounds.
    """
    resolve(plan, **values)
    changes = {f"parameters.{name}.value": value for name, value in values.items()}
    return AssemblyPlan.from_json(amended(document_of(plan), changes))


def _pair(stored: Mapping[str, Any]) -> PairCheck:
    """Return a verdict read from `checks.json`."""
    kept = stored["strength"]
    strength = Strength(kept["kind"], kept.get("epsilon_mm"), kept.get("poses"), kept.get("step"), kept.get("reason", ""))
    over: Sequence[str] | str = stored["over"]
    return PairCheck(
        (stored["parts"][0], stored["parts"][1]),
        stored["relation"],
        over if isinstance(over, str) else tuple(over),
        strength,
        volume=stored["volume_mm3"],
        depth=stored["depth_mm"],
        allowed=stored["allowed_mm"],
        gap=stored["gap_mm"],
        verdict=stored["verdict"],
    )
