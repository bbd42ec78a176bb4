"""Reading: converts JSON text to a form, and reports every deviation from it as a finding at its path."""

from __future__ import annotations

import dataclasses
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Final, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from articad.errors import PlanError, ReadError, did_you_mean
from articad.files import PLAN_BYTES, read_file
from articad.findings import Finding, Findings
from articad.plan.fields import NAME_RULE, PlanObject, is_name
from articad.plan.joint_forms import JOINT_TYPES, JointForm
from articad.plan.short import copied_fields, expanded, functions_of, is_short, joints_with_a_place
from articad.plan.short_texts import CLAUSES
from articad.plan.signatures import Functions
from articad.texts import escaped

F = TypeVar("F", bound=PlanObject)
Location = tuple[str | int, ...]

MOST_LEVELS: Final = 100  # of nested lists and objects; a plan has ten
_SHOWN = 60  # characters of a wrong value that are quoted
_LISTED_ERRORS = 5  # findings that an exception's own text shows; all of them are in `.findings`
_CONTAINERS = {
    "dict_type": "an object {…}",
    "model_type": "an object {…}",
    "model_attributes_type": "an object {…}",
    "tuple_type": "a list […]",
}
_ELSEWHERE = {  # joint names of URDF, MJCF, SDF, USD and CAD systems
    "continuous": 'revolute, with "angle_deg": "endless"',
    "helical": "screw",
    "hinge": "revolute",
    "prismatic": "slider",
    "rigid": "fixed",
    "slide": "slider",
    "spherical": "ball",
    "weld": "fixed",
}
MOST_FINDINGS = 1000  # of one plan that are put into words
_LIMIT_KEYS = ("angle_deg", "travel_mm", "rest_deg", "rest_mm", "cone_deg", "twist_deg", "lead_mm", "x_mm", "y_mm", "a_deg", "b_deg")


def load(form: type[F], path: Path, default_name: str) -> F:
    """Read a form from a file, or from the file of the default name in a folder.

    Raises:
        PlanError: If the text does not have the form.
        ReadError: If there is no such file, or it cannot be read.
    """
    file = path / default_name if path.is_dir() else path
    try:
        text = read_file(file, PLAN_BYTES, root=path if path.is_dir() else None)
    except OSError as error:
        raise ReadError(f"{file} cannot be read: {error.strerror}.", path=str(file)) from None
    return loads(form, text, file)


def loads(form: type[F], text: str | bytes, file: Path | None = None) -> F:
    """Read a form from JSON text.

    Args:
        form: The form.
        text: The text.
        file: Where it was read; part scripts beside it may state dimensions of a plan in the short form.

    Raises:
        PlanError: With all findings.
    """
    repeated: dict[str, None] = {}
    try:
        document = json.loads(text, object_pairs_hook=lambda pairs: _unique_keys(pairs, repeated))
    except json.JSONDecodeError as error:
        where = f"line {error.lineno} column {error.colno}"
        line = "".join(error.doc.split("\n")[error.lineno - 1 :][:1]).strip()[:_SHOWN]
        hint = "Give one JSON object: keys and texts in double quotes, no comments, no comma before } or ]."
        raise _refused([_finding("E_SCHEMA", where, f"This is not JSON: {error.msg} at {line!r}.", hint)]) from None
    except (UnicodeDecodeError, RecursionError, ValueError) as error:
        reason = {RecursionError: "it is nested too deeply", UnicodeDecodeError: "it is not UTF-8"}.get(type(error), str(error))
        raise _refused([_finding("E_SCHEMA", "plan", f"This is not JSON: {reason}.", "Give one JSON object in UTF-8.")]) from None
    if is_nested_deeper(document, MOST_LEVELS):
        problem = f"This plan is nested deeper than {MOST_LEVELS} levels."
        raise _refused([_finding("E_SCHEMA", "plan", problem, "Give one JSON object in UTF-8.")])
    if not repeated:
        return from_json(form, document, functions_of(document, file) if file else None)
    twice = [_finding("E_SCHEMA", "plan", f"The key {key!r} occurs twice in one object.", "Remove one of them.") for key in repeated]
    try:
        from_json(form, document)
    except PlanError as error:
        twice += error.findings
    raise _refused(twice)


def is_nested_deeper(value: Any, most: int) -> bool:
    """Return whether JSON has more nested levels of lists and objects than `most`; without recursion."""
    level = [value]
    for _ in range(most + 1):
        level = [
            item for outer in level if isinstance(outer, (list, dict)) for item in (outer if isinstance(outer, list) else outer.values())
        ]
        if not level:
            return False
    return True


def from_json(form: type[F], document: Any, functions: Functions | None = None) -> F:
    """Return the form made from a JSON document in memory.

    Args:
        form: The form.
        document: The document.
        functions: The functions that build the parts of a plan in the short form.

    Raises:
        PlanError: With all findings.
    """
    if not isinstance(document, Mapping):
        raise _refused([_finding("E_SCHEMA", "plan", f"A plan is an object {{…}}, not {_shown(document)}.", "Give one JSON object.")])
    places, copies = joints_with_a_place(document), copied_fields(document)
    short = is_short(document)
    document = expanded(document, functions)
    try:
        return form.model_validate(document)
    except ValidationError as error:
        details = error.errors(include_url=False)
    found = [_translated(form, document, detail) for detail in details[:MOST_FINDINGS]]
    found = _without_copies(_with_places(found, document, places), copies) if short else found
    if (more := len(details) - MOST_FINDINGS) > 0:
        found.append(_finding("E_SCHEMA", "plan", f"There are {more} more errors, which are not listed.", "Correct the listed ones first."))
    raise _refused(found) from None


def _with_places(found: list[Finding], document: Any, places: Sequence[str]) -> list[Finding]:
    """Report each "at" of the short form that is no place once, instead of the ends of its joint, which lack their connectors for it.

    Args:
        found: Findings about the expanded document.
        document: The expanded document.
        places: Joints that have a place.
    """
    joints = document.get("joints")
    lost = (
        {str(joint.get("name")): joint["at"] for joint in joints if isinstance(joint, Mapping) and "at" in joint}
        if isinstance(joints, list)
        else {}
    )
    about = {f"joints.{name}.{key}" for name in lost for key in ("at", "parent", "child")}
    named = f", or the name of a joint that is there: {', '.join(places)}" if places else ""
    hint = f"Give a point [x, y, z], or [o, z] or [o, z, x], in the assembly's frame{named}."
    told = [
        _finding(
            "E_SCHEMA",
            f"joints.{name}.at",
            f"{_shown(at)} is no place: a plan has no shapes that could name one.",
            hint + did_you_mean(str(at), places),
        )
        for name, at in lost.items()
    ]
    return [_for_a_text(one) for one in found if one.code != "E_SCHEMA" or one.where not in about] + told


def _without_copies(found: list[Finding], copies: Mapping[str, tuple[str, frozenset[str]]]) -> list[Finding]:
    """Leave out what is told of a part or joint because it is like another, of which the same is told."""
    told = {(one.where, one.message) for one in found}

    def is_copied(one: Finding) -> bool:
        kind, _, rest = one.where.partition(".")
        name, _, field = rest.partition(".")
        source, own = copies.get(f"{kind}.{name}", ("", frozenset()))
        return bool(field) and field.partition(".")[0].partition("[")[0] not in own and (f"{source}.{field}", one.message) in told

    return [one for one in found if not is_copied(one)]


_TEXTS: Final = (
    (
        re.compile(r"parts\.\w+\.dimensions"),
        'Give "width, low = -t; material oak; at 0,0,10": dimensions first, then clauses material, at, turn, like, envelope, color.',
    ),
    (re.compile(r"parameters"), 'Give "width = 400, low = -width / 2", or an object by name.'),
)
"""Hints for texts of the short form that cannot be read, by their addresses."""
_UNKNOWN: Final = re.compile(r"There is no field '(\w+)' here\.")
_BELONGS: Final = {
    "blind": "It belongs to a hinge, dowel or drawer_slide that states the length of its pin or bar, and no depth.",
    **dict.fromkeys(("head_mm", "tail_mm"), 'It belongs to a hinge on a pin of its own, "hinge PARENT CHILD PIN".'),
}
"""Hints for fields of standard joints where they have no meaning."""


def _for_a_text(one: Finding) -> Finding:
    """Return a finding with a hint about the short form, if it is about a text there."""
    if one.where.startswith("joints.") and (unknown := _UNKNOWN.fullmatch(one.message)):
        meant = _BELONGS.get(unknown[1]) or did_you_mean(unknown[1], CLAUSES).strip()
        return dataclasses.replace(one, hint=f"{meant} Otherwise leave it out.") if meant else one
    hint = next((hint for address, hint in _TEXTS if one.code == "E_SCHEMA" and address.fullmatch(one.where)), None)
    return one if hint is None or " cannot be " not in one.message else dataclasses.replace(one, hint=hint)


def _unique_keys(pairs: list[tuple[str, Any]], repeated: dict[str, None]) -> dict[str, Any]:
    """Build an object of the first value of each key; add the repeated keys, of which Python would silently keep the last."""
    unique: dict[str, Any] = {}
    for key, value in pairs:
        if key in unique:
            repeated[key] = None
        else:
            unique[key] = value
    return unique


def _refused(findings: Sequence[Finding]) -> PlanError:
    every = Findings(findings)
    shown = "\n".join(map(str, every[:_LISTED_ERRORS]))
    more = f"\n… and {len(every) - _LISTED_ERRORS} more." if len(every) > _LISTED_ERRORS else ""
    return PlanError(shown + more, findings=every)


def _finding(code: str, where: str, message: str, hint: str) -> Finding:
    return Finding(code=code, where=escaped(where), message=escaped(message), hint=hint)  # they quote what may not be text


# ---------------------------------------------------------------- one of pydantic's errors


def _translated(form: type[PlanObject], document: Any, detail: ErrorDetails) -> Finding:
    """Return the finding of one of pydantic's errors, in the words of the plan."""
    kind, context = detail["type"], detail.get("ctx") or {}
    location, owner, raw_owner = _resolved(form, document, detail["loc"], kind)
    if "element" in context:
        location = (*location, context["element"])
    where, key, value = _path(document, location), str(location[-1]) if location else "plan", value_at(document, location)
    match kind:
        case "plan_name":
            return _finding("E_NAME", where, f"{_shown(key if _is_key(detail) else value)} is not a valid name.", NAME_RULE)
        case "missing":
            return _missing(where, key, owner)
        case "extra_forbidden":
            return _unknown_key(where, key, owner, raw_owner)
        case "union_tag_invalid" | "union_tag_not_found":
            return _unknown_tag(where, location, document, context)
        case _:
            return _wrong_value(where, key, value, detail, on_joint=owner is not None and issubclass(owner, JointForm))


def _wrong_value(where: str, key: str, value: Any, detail: ErrorDetails, *, on_joint: bool) -> Finding:
    kind, context = detail["type"], detail.get("ctx") or {}
    if kind == "plan_nonfinite":
        return _finding("E_NONFINITE", where, f"{_shown(value)} is not a finite number.", "Give a finite number.")
    if kind == "plan_expression_length":
        return _finding("E_EXPRESSION", where, "The expression is longer than 200 characters.", "Move a piece of it into a parameter.")
    if on_joint and value == "endless":
        hint = (
            "Give [lower, upper]; only the angle of a revolute, cylindrical, screw or planar joint and a cylindrical travel may be endless."
        )
        return _finding("E_LIMITS_KIND", where, f"{key} of this joint cannot be endless.", hint)
    if key == "rest_pose":
        hint = 'Give a pose such as {"at": [0, 0, 10]}, or "auto".'
    else:
        hint = f"Give {context.get('form') or _CONTAINERS.get(kind) or _expected(context) or detail['msg']}."
    if kind == "literal_error":
        allowed = [word.strip("'") for word in str(context.get("expected", "")).replace(" or ", ", ").split(", ")]
        hint += did_you_mean(str(value), allowed)
    return _finding("E_SCHEMA", where, f"{key} cannot be {_shown(value)}.", hint)


def _missing(where: str, key: str, owner: type[PlanObject] | None) -> Finding:
    field = _field(owner, key)
    purpose = field.description if field else None
    hint = f"Add {key!r}{': ' + purpose if purpose else ''}."
    if where.startswith("allow"):
        hint = "A waiver names two parts, the largest depth in mm that is accepted, and the reason."
        return _finding("E_ALLOW", where, f"A waiver has no {key!r}.", hint)
    return _finding("E_SCHEMA", where, f"{key!r} is missing.", hint)


def _unknown_key(where: str, key: str, owner: type[PlanObject] | None, raw_owner: Any) -> Finding:
    allowed = _keys(owner) if owner else []
    if owner is not None and issubclass(owner, JointForm) and key in _LIMIT_KEYS:
        kind = raw_owner.get("type") if isinstance(raw_owner, Mapping) else None
        own = [name for name in allowed if name in _LIMIT_KEYS]
        hint = f"A {kind} joint has {', '.join(own)}." if own else f"A {kind} joint has no limits: remove {key}, or change its type."
        return _finding("E_LIMITS_KIND", where, f"{key!r} does not belong to a {kind} joint.", hint)
    closest = did_you_mean(key, allowed).strip()
    hint = f"{closest} Allowed here: {', '.join(allowed)}. Otherwise leave it out.".strip()
    return _finding("E_SCHEMA", where, f"There is no field {key!r} here.", hint)


def _unknown_tag(where: str, location: Location, document: Any, context: Mapping[str, Any]) -> Finding:
    raw = value_at(document, location)
    if not isinstance(raw, Mapping):
        return _finding("E_SCHEMA", where, f"{_shown(raw)} is not an object.", "Give an object {…}.")
    collection = str(location[0])
    key = "op" if collection == "parts" else "type"
    expected = str(context.get("expected_tags", "")).replace("'", "")
    valid = [tag for tag in (expected.split(", ") if expected else JOINT_TYPES) if tag != "derived"]
    known_as = _ELSEWHERE.get(str(raw.get(key))) if collection == "joints" else None
    closest = f" Here it is called {known_as}." if known_as else did_you_mean(str(raw.get(key)), valid)
    hint = f"{closest} Valid: {', '.join(valid)}.".strip()
    if key not in raw:
        return _finding("E_SCHEMA", f"{where}.{key}", f"{key!r} is missing.", hint)
    return _finding("E_SCHEMA", f"{where}.{key}", f"There is no {collection.rstrip('s')} {key} {_shown(raw[key])}.", hint)


def _expected(context: Mapping[str, Any]) -> str:
    return str(context["expected"]).replace("'", '"') if "expected" in context else ""


def _is_key(detail: ErrorDetails) -> bool:
    return bool(detail["loc"]) and detail["loc"][-1] == "[key]"


# ---------------------------------------------------------------- places


def _resolved(form: type[PlanObject], document: Any, loc: Location, kind: str) -> tuple[Location, type[PlanObject] | None, Any]:
    """Return the place of an error without the tags of unions, the form that holds it, and that form's raw value."""
    node: Any = document
    owner: type[PlanObject] | None = form
    raw_owner: Any = document
    candidates: list[type[PlanObject]] = []
    kept: list[str | int] = []
    for step in loc:
        if isinstance(step, int) and isinstance(node, Sequence):
            node = node[step] if step < len(node) else None
            kept.append(step)
        elif isinstance(node, Mapping) and step in node:
            field = _field(owner, str(step)) if node is raw_owner else None
            candidates = list(_forms_in(field.annotation)) if field else candidates
            node = node[step]
            kept.append(step)
        elif isinstance(node, Mapping) and kind == "missing" and step == loc[-1]:
            kept.append(step)
            break
        else:
            continue  # a union's tag, or "[key]"
        if isinstance(node, Mapping) and candidates and step != loc[-1]:
            owner, raw_owner, candidates = _chosen(candidates, node), node, []
    return tuple(kept), owner, raw_owner


def _chosen(candidates: list[type[PlanObject]], raw: Mapping[str, Any]) -> type[PlanObject] | None:
    """Return the form of a union that a raw object is meant to be."""
    for candidate in candidates:
        if ("derive" in candidate.model_fields) != ("derive" in raw) and any("derive" in other.model_fields for other in candidates):
            continue
        literals = {key: get_args(field.annotation) for key, field in candidate.model_fields.items() if key in {"type", "op"}}
        if all(raw.get(key) in values for key, values in literals.items()):
            return candidate
    return None


def _forms_in(annotation: Any) -> Iterator[type[PlanObject]]:
    if isinstance(annotation, type) and issubclass(annotation, PlanObject):
        yield annotation
    elif get_origin(annotation) in {Annotated, Union, UnionType, tuple, dict}:
        for argument in get_args(annotation):
            yield from _forms_in(argument)


def _field(owner: type[BaseModel] | None, key: str) -> Any:
    if owner is None:
        return None
    return next((field for name, field in owner.model_fields.items() if key in {name, field.alias}), None)


def _keys(owner: type[PlanObject]) -> list[str]:
    return [field.alias or name for name, field in owner.model_fields.items()]


def value_at(document: Any, location: Location) -> Any:
    """Return what a document has at a location; None if there is nothing."""
    for step in location:
        try:
            document = document[step]
        except (KeyError, IndexError, TypeError):
            return None
    return document


def _path(document: Any, location: Location) -> str:
    """Return the path that findings show: names of list items where they have one, as in parts.door.connectors.hinge.z."""
    text = ""
    node = document
    for step in location:
        node = value_at(node, (step,))
        if isinstance(step, int):
            name = node.get("name") if isinstance(node, Mapping) else None
            text += f".{name}" if isinstance(name, str) and is_name(name) else f"[{step}]"
        else:
            text += f".{step}"
    return text.lstrip(".") or "plan"


def _shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
