"""Obedience: what the hints of findings tell a reader to change in a plan, read literally.

Each wording of a hint has a rule, and each alternative of a hint a rule of its own. The rules know nothing but the hint, its finding and the plan.
"""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable
from difflib import SequenceMatcher
from typing import Any, NamedTuple

from articad.findings import Finding
from articad.plan.amending import amended

__all__ = ["RULES", "Rule", "followed"]

Json = dict[str, Any]
Match = re.Match[str]
Follow = Callable[[Finding, Json, Match], Json]


class Rule(NamedTuple):
    """What a hint of this wording tells its reader to change; an alternative of a hint has a rule of its own."""

    words: str
    changes: Follow


def numbers(text: str) -> list[Any]:
    """Read (1, 2, 3) and [1, 2]."""
    read: list[Any] = json.loads(f"[{text.strip('()[]')}]")
    return read


def value_at(plan: Json, address: str) -> Any:
    """Return what stands at an address of a finding."""
    held: Any = plan
    for step in re.sub(r"\[(\d+)\]", r".\1", address).split("."):
        if isinstance(held, list):
            names = [entry.get("name") if isinstance(entry, dict) else None for entry in held]
            held = held[names.index(step) if step in names else int(step)]
        else:
            held = held.get(step)
    return held


def _entry(plan: Json, room: str, name: str) -> Json:
    found: Json = next(each for each in plan[room] if each["name"] == name)
    return found


def above(address: str) -> str:
    return address.rpartition(".")[0]


def last(address: str) -> str:
    return address.rpartition(".")[2]


def here(value: Any) -> Follow:
    return lambda finding, _plan, _match: {finding.where: value}


def here_numbers(finding: Finding, _plan: Json, match: Match) -> Json:
    return {finding.where: numbers(match[1])}


def here_json(finding: Finding, _plan: Json, match: Match) -> Json:
    return {finding.where: json.loads(match[1])}


def beside(finding: Finding, _plan: Json, match: Match) -> Json:
    return {f"{above(finding.where)}.{match[1]}": json.loads(match[2])}


def respelt(finding: Finding, plan: Json, match: Match) -> Json:
    """Replace that quoted word of the message which stands at the place and is spelt most like the suggestion."""
    written = json.dumps(value_at(plan, finding.where))
    quoted = sorted(re.findall(r"'(\w+)'", finding.message), key=lambda word: -SequenceMatcher(None, word, match[1]).ratio())
    changed = [right for wrong in quoted if (right := re.sub(rf"\b{wrong}\b", match[1], written)) != written]
    assert changed, f"{finding} quotes nothing of {written}"
    return {finding.where: json.loads(changed[0])}


def connectors_of(plan: Json, name: str) -> list[Json]:
    """Return the connectors of a part, for a copy those of its source."""
    held = next(each for each in plan["parts"] if each["name"] in (name, re.sub(r"_\d+$", "", name)))
    return held["connectors"] if "connectors" in held else connectors_of(plan, held["derive"]["from"])


def on_connector(finding: Finding, _plan: Json, match: Match) -> Json:
    """Set o, z, x of part.connector to (..), and perhaps a second of them."""
    found: Json = {}
    if "which comes from" in (finding.hint or ""):  # of a copy: to be changed where it comes from
        return found
    for key, owner, connector, triple in re.findall(r"(\b[ozx]) of (\w+)\.(\w+) to (\(.*?\))", match[0]):
        found[f"parts.{owner}.connectors.{connector}.{key}"] = numbers(triple)
    return found


def renamed(finding: Finding, _plan: Json, _match: Match) -> Json:
    return {f"{finding.where}.name": f"{last(finding.where)}_2"}


def renamed_everywhere(finding: Finding, plan: Json, match: Match) -> Json:
    """Rename a parameter where it is declared, and in all texts that are not words or names."""
    old = finding.where.split(".")[1]
    words = {"schema", "name", "description", "orientation", "role", "label", "parent", "child", "material", "ground", "assumptions"}

    def written(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: entry if key in words else written(entry) for key, entry in value.items()}
        if isinstance(value, list):
            return [written(entry) for entry in value]
        return re.sub(rf"\b{old}\b", match[1], value) if isinstance(value, str) else value

    changed: Json = {room: written(entries) for room, entries in plan.items() if room in {"parameters", "parts", "joints", "couplings"}}
    _entry(changed, "parameters", old)["name"] = match[1]
    return changed


def scaled(factor: float) -> Follow:
    def change(_finding: Finding, plan: Json, _match: Match) -> Json:
        boxes = {each["name"]: each["envelope_mm"] for each in plan["parts"] if "envelope_mm" in each}
        return {f"parts.{name}.envelope_mm": [side * factor for side in box] for name, box in boxes.items()}

    return change


def connector_of_its_own(finding: Finding, plan: Json, _match: Match) -> Json:
    """Give the second of the joints that share a connector a copy of it."""
    names = re.search(r"Joints (\w+) and (\w+)", finding.message)
    assert names
    owner = finding.parts[0]
    side = next(side for side in ("parent", "child") if _entry(plan, "joints", names[2])[side] == f"{owner}.{last(finding.where)}")
    return {
        f"{finding.where}_2": {key: value for key, value in value_at(plan, finding.where).items() if key != "name"},
        f"joints.{names[2]}.{side}": f"{owner}.{last(finding.where)}_2",
    }


def connectors_that_joints_name(finding: Finding, plan: Json, _match: Match) -> Json:
    owner = finding.parts[0] if finding.parts else finding.where.split(".")[1]
    ends = [end.split(".") for each in plan["joints"] for end in (each["parent"], each["child"])]
    return {f"{finding.where}.{name}": {"o": [0, 0, 0], "z": [1, 0, 0], "label": ""} for mine, name in ends if mine == owner}


def joined(finding: Finding, plan: Json, _match: Match) -> Json:
    loose = re.search(r"\[\['(\w+)'", finding.message)
    anchor = re.search(r"one of \['(\w+)'", finding.hint or "")
    assert loose
    assert anchor
    own = connectors_of(plan, loose[1])[0]
    return {
        f"parts.{anchor[1]}.connectors.for_{loose[1]}": {key: value for key, value in own.items() if key != "name"},
        f"joints.hold_{loose[1]}": {"type": "fixed", "parent": f"{anchor[1]}.for_{loose[1]}", "child": f"{loose[1]}.{own['name']}"},
    }


def another_part(finding: Finding, plan: Json, _match: Match) -> Json:
    if finding.where.startswith("allow"):
        return {finding.where: [each["name"] for each in plan["parts"]][:2]}
    own = _entry(plan, "joints", last(finding.where))["parent"].split(".")[0]
    other = next(each for each in plan["parts"] if each["name"] != own)
    return {f"{finding.where}.child": f"{other['name']}.{connectors_of(plan, other['name'])[0]['name']}"}


def exchanged(finding: Finding, plan: Json, _match: Match) -> Json:
    held = value_at(plan, finding.where)
    return {f"{finding.where}.parent": held["child"], f"{finding.where}.child": held["parent"]}


def held_fast(finding: Finding, plan: Json, _match: Match) -> Json:
    return {finding.where: None, f"{above(finding.where)}.type": "fixed", "freedoms": plan["freedoms"] - 1}


def without_other_driver(finding: Finding, _plan: Json, _match: Match) -> Json:
    told = re.search(r"but (\w+)[^,]* already drive", finding.message)
    assert told
    return {f"joints.{told[1]}.driver": None}


def moved_key(finding: Finding, plan: Json, match: Match) -> Json:
    return {finding.where: None, f"{above(finding.where)}.{match[1]}": value_at(plan, finding.where)}


def without_count(finding: Finding, plan: Json, _match: Match) -> Json:
    return {finding.where: None, finding.where.removesuffix("_count"): value_at(plan, finding.where)}


def at_value(finding: Finding, plan: Json, _match: Match) -> Json:
    return {finding.where: value_at(plan, above(finding.where))["value"]}


def on_its_own(finding: Finding, plan: Json, match: Match) -> Json:
    """Write out a part or joint of a circle, as another one of the list is written."""
    kind = finding.where.split(".")[0]
    plain = next(each for each in plan[kind] if "derive" not in each)
    kept = {key: value for key, value in value_at(plan, f"{kind}.{match[1]}").items() if key in ("parent", "child")}
    return {f"{kind}.{match[1]}": {**copy.deepcopy(plain), **kept, "name": match[1]}}


def derived(finding: Finding, plan: Json, match: Match) -> Json:
    held = value_at(plan, finding.where)
    return {finding.where: {key: held[key] for key in ("name", "parent", "child")} | {"derive": json.loads(match[1])}}


def turned_in_place(finding: Finding, plan: Json, _match: Match) -> Json:
    return {finding.where: {"from": value_at(plan, finding.where)["from"], "op": "rigid", "move": {}}}


def without_side(_finding: Finding, plan: Json, match: Match) -> Json:
    shared = {f"parts.{match[1]}.connectors.{each['name']}.label": each["label"] for each in _entry(plan, "parts", match[1])["connectors"]}
    return {address: re.sub("left|right", "outer", label) for address, label in shared.items()}


def suitable_joints(finding: Finding, plan: Json, match: Match) -> Json:
    kinds = {"revolute": "an angle about a joint's z", "slider": "a travel"}
    chosen: list[str] = []
    for wanted in match.groups():
        chosen.append(next(each["name"] for each in plan["joints"] if kinds.get(each["type"]) == wanted and each["name"] not in chosen))
    return {finding.where: chosen}


def two_joints(finding: Finding, plan: Json, _match: Match) -> Json:
    return {finding.where: [each["name"] for each in plan["joints"]][:2]}


def a_joint_that_moves(finding: Finding, plan: Json, _match: Match) -> Json:
    taken = value_at(plan, re.sub(r"\[\d\]$", "", finding.where))
    return {finding.where: next(each["name"] for each in plan["joints"] if each["type"] != "fixed" and each["name"] not in taken)}


def linear(finding: Finding, plan: Json, _match: Match) -> Json:
    tie = value_at(plan, ".".join(finding.where.split(".")[:2]))
    return {".".join(finding.where.split(".")[:2]): {"name": tie["name"], "type": "linear", "joints": tie["joints"], "ratio": 1}}


def limited(finding: Finding, _plan: Json, match: Match) -> Json:
    return {f"{finding.where}.{'angle_deg' if match[2] == 'deg' else 'travel_mm'}": json.loads(match[1])}


def offered_at(place: int) -> Follow:
    """Return what follows the n-th of the changes that are said to end all findings."""

    def change(_finding: Finding, _plan: Json, match: Match) -> Json:
        decoder, text, held = json.JSONDecoder(), match[1], []
        while text.startswith("{"):
            one, end = decoder.raw_decode(text)
            held.append(one)
            text = text[end:].removeprefix(" or ")
        return held[place] if place < len(held) else {}

    return change


def address_set(place: int) -> Follow:
    """Return what follows the n-th of addresses that are to be set to numbers."""

    def change(_finding: Finding, _plan: Json, match: Match) -> Json:
        pairs = re.findall(_ADDRESS, match[0])
        return {pairs[place][0]: json.loads(pairs[place][1])} if place < len(pairs) else {}

    return change


def built_if(place: int) -> Follow:
    """Return what follows the n-th of the numbers with which a script would build."""

    def change(_finding: Finding, _plan: Json, match: Match) -> Json:
        pairs = re.findall(r"if ((?:parts|parameters)\.[\w.]+) is (-?[\d.e+-]+) instead of", match[0])
        return {pairs[place][0]: float(pairs[place][1])} if place < len(pairs) else {}

    return change


_ADDRESS = r"((?:parts|joints|parameters)\.[\w.]+) to (-?[\d.]*\d|\[.*?\])"
_ALONE = r"(?:alone ends|One change ends) (?:this finding|all \d+ findings): (\{.*)"

RULES = [
    *(Rule(_ALONE, offered_at(place)) for place in range(3)),
    *(Rule(rf"Set {_ADDRESS}(, or {_ADDRESS})*", address_set(place)) for place in range(5)),
    *(Rule(r"The script of \w+ builds if .*", built_if(place)) for place in range(4)),
    Rule(r"Set its limits to (\[.*?\]) (deg|mm)", limited),
    Rule(r"or widen those of (\w+)", lambda _finding, _plan, match: {f"joints.{match[1]}.angle_deg": "endless"}),
    Rule(r"Remove the driver mark of '(\w+)'", lambda _finding, _plan, match: {f"joints.{match[1]}.driver": None}),
    Rule(r"or of the joint that it is to replace", without_other_driver),
    Rule(r"Remove a coupling|or remove 'environment'", here(None)),
    Rule(r"^Parameters: (\w+)", respelt),
    Rule(
        r"Declare connector '(\w+)' on (\w+)",
        lambda _f, _p, m: {f"parts.{m[2]}.connectors.{m[1]}": {"o": [0, 0, 0], "z": [1, 0, 0], "label": ""}},
    ),
    Rule(r"Rename it, for example to (\w+), here and in each expression", renamed_everywhere),
    Rule(r"Write it in parameters: (['\"])(.+)\1\.", lambda finding, _plan, match: {finding.where: match[2]}),
    Rule(r"Rename all but one", renamed),
    Rule(r"Did you mean '(\w+)'\?", respelt),
    Rule(r"Give one of (\w+)\b.* a number", lambda _finding, _plan, match: {f"parameters.{match[1]}.value": 1}),
    Rule(r"Change the expression", here(10)),
    Rule(r"Set the value to (\S+),", lambda finding, _plan, match: {f"{finding.where}.value": float(match[1])}),
    Rule(r"Set the value to \S+, or (min|max) to (\S+)\.", lambda finding, _plan, match: {f"{finding.where}.{match[1]}": float(match[2])}),
    Rule(
        r"Did you mean min (\S+), max (\S+)\?",
        lambda finding, _plan, match: {f"{finding.where}.min": float(match[1]), f"{finding.where}.max": float(match[2])},
    ),
    Rule(r"Narrow the (?:min|max) of", at_value),
    Rule(r"Give (\d+), or rename it", lambda finding, _plan, match: {finding.where: int(match[1])}),
    Rule(r"rename it without _count", without_count),
    Rule(r"Give kg/m³: steel (\d+)", lambda finding, _plan, match: {finding.where: int(match[1])}),
    Rule(r"such as (-?[\d.]*\d)", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"such as ([\[(].*?[\])])", here_numbers),
    Rule(r"Give three positive lengths", here(10)),
    Rule(r"were metres given\?$", scaled(1000)),
    Rule(r"were micrometres given\?$", scaled(0.001)),
    Rule(r"Make it (-?[\d.]+); or name a place", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"Then it is (\S+?)[;.](?:\s|$)", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"or make it (\S+), as (?:'\w+' of|far as)", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"or make it at least (\S+) mm", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"set density_kg_m3 to (\S+);", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"Did you mean x=(\(.*?\))", here_numbers),
    Rule(r"Set x to (\(.*?\))", here_numbers),
    Rule(r"Use kind '(\w+)'", lambda finding, _plan, match: {finding.where: match[1]}),
    Rule(r"Use kind .* or '(\w+)'", lambda finding, _plan, match: {finding.where: match[1]}),
    Rule(r"Use it in a joint, or remove it", here(None)),
    Rule(r"Set its kind to '(\w+)'", lambda finding, _plan, match: {f"{finding.where}.kind": match[1]}),
    Rule(r"eclare a connector for each joint", connector_of_its_own),
    Rule(r"Declare a connector where", connectors_that_joints_name),
    Rule(r"Name two different parts", another_part),
    Rule(r"Remove one of them|Remove the driver mark(?! of)|eave it out|Remove one joint of the loop", here(None)),
    Rule(r"drop 'tree'", lambda _finding, _plan, _match: {"tree": None}),
    Rule(r"Choose one of \['(\w+)'", lambda finding, _plan, match: {finding.where: match[1]}),
    Rule(r"Add a joint between", joined),
    Rule(r"Exchange its parent and child", exchanged),
    Rule(r"Set freedoms to (\d+)", lambda finding, _plan, match: {finding.where: int(match[1])}),
    Rule(r'Add "\w+": (\[.*?\])', here_json),
    Rule(r'or "endless"', here("endless")),
    Rule(r"Did you mean (\[.*?\])\?", here_json),
    Rule(r"Give an angle above 0 up to 180", here(90)),
    Rule(r"Make it a fixed joint and declare one freedom less", held_fast),
    Rule(r"or open the range", here([0, 90])),
    Rule(r"If radians were meant, give (\[.*?\]|-?[\d.]*\d)\.", here_json),
    Rule(r"If the sign is wrong, give (\[.*?\])\.", here_json),
    Rule(r"Give degrees within \[-720, 720\]", here([0, 720])),
    Rule(r"Set (rest_\w+) to (\S+),", beside),
    Rule(r", or (\w+) to (\[.*?\])\.", beside),
    Rule(r", or (rest_\w+) of the joint to (-?[\d.]*\d)", lambda finding, _plan, match: {f"{finding.where}.{match[1]}": float(match[2])}),
    Rule(r"Let it turn: (\{.*?\})", lambda _finding, _plan, match: json.loads(match[1])),
    Rule(r"widen \w+ to (\[.*?\])", here_json),
    Rule(r"make it a revolute joint", lambda finding, _plan, _match: {f"{above(finding.where)}.type": "revolute", finding.where: None}),
    Rule(r"Use (\w+) instead", moved_key),
    Rule(r"Give a positive number", here(1)),
    Rule(r"Set mate to '(\w+)'", lambda finding, _plan, match: {f"{finding.where}.mate": match[1]}),
    Rule(r"et [ozx] of \w+\.\w+ to \(.*?\)( and [ozx] of \w+\.\w+ to \(.*?\))*", on_connector),
    Rule(r"rest_pose\.at of (\w+) to (\(.*?\))", lambda _finding, _plan, match: {f"parts.{match[1]}.rest_pose.at": numbers(match[2])}),
    Rule(r"Give (\w+) a rest_pose with numbers", lambda _finding, _plan, match: {f"parts.{match[1]}.rest_pose": {}}),
    Rule(r"Give the ground a rest_pose", here({})),
    Rule(r"Define one of (\w+)", on_its_own),
    Rule(r"The nearest is (\d+)", lambda finding, _plan, match: {finding.where: int(match[1])}),
    Rule(r"Set child to (\w+\.\w+)", lambda finding, _plan, match: {finding.where: match[1]}),
    Rule(r"Set op to '(\w+)'", lambda finding, _plan, match: {f"{above(finding.where)}.derive.op": match[1]}),
    Rule(r"A symmetric motion needs (\w+) (\[.*?\])", lambda finding, _plan, match: {f"{finding.where}.{match[1]}": json.loads(match[2])}),
    Rule(r"or derive the joint: (\{.*?\})", derived),
    Rule(r"derive it with op 'rigid'", turned_in_place),
    Rule(r"Name or label the connectors of (\w+) without a side", without_side),
    Rule(r"exchange them, (\[.*?\])", here_json),
    Rule(r"joints\[0\] must be (an angle about a joint's z|a travel), joints\[1\] (an angle about a joint's z|a travel)", suitable_joints),
    Rule(r'or use a linear coupling|or use "type": "linear" with a ratio', linear),
    Rule(r"Name two different joints", two_joints),
    Rule(r"Use (\w+\.\w+) or", lambda finding, _plan, match: {finding.where: match[1]}),
    Rule(r"Couple an angle or a travel", a_joint_that_moves),
    Rule(r"Give a whole number of teeth|Give a positive length|Give a number other than zero", here(1)),
    Rule(r"Set offset to (\S+)\.", lambda finding, _plan, match: {finding.where: float(match[1])}),
    Rule(r"Give (\[.*?\]) and contact '(\w+)'", lambda f, _p, m: {f.where: json.loads(m[1]), f"{above(f.where)}.contact": m[2]}),
    Rule(
        r"set contact to '(\w+)'|, or contact to '(\w+)'", lambda finding, _plan, match: {f"{finding.where}.contact": match[1] or match[2]}
    ),
    Rule(r"Raise the largest gap above 0", lambda finding, _plan, _match: {f"{finding.where}.gap_mm": [0, 1]}),
    Rule(r"Set the least gap to 0", lambda finding, _plan, _match: {f"{finding.where}.gap_mm.0": 0}),
    Rule(r"Give the radius about the axis", here(1)),
    Rule(r"Say why this overlap is meant", here("A press fit.")),
]
"""Every wording of a hint of the plan's checks, each alternative by itself."""


def followed(finding: Finding, plan: Json) -> list[Json]:
    """Return the plan after each of the changes that a hint offers, in its order."""
    advice = (finding.hint or "").partition("At this value alone:")[0]  # what follows is about another value than the plan's
    matches = [(match.start(), rule, match) for rule in RULES if (match := re.search(rule.words, advice))]
    changes = [rule.changes(finding, plan, match) for _, rule, match in sorted(matches, key=lambda one: one[0])]
    return [amended(plan, change) for change in changes if change]
