"""Mistakes in plans, by rule: units, signs, places, limits, structure, couplings and fits."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Final

from articad_bench.faulty import Json, Kind, Product, Site

__all__ = ["PLAN_KINDS"]

FORM: Final = frozenset({"E_SCHEMA", "E_NAME", "E_NONFINITE", "E_EXPRESSION"})
PLACE: Final = frozenset(
    {"E_MATE_OFFSET", "E_MATE_FLIP", "E_MATE_TILT", "E_MATE_ROLL", "W_PARAMETER_RANGE", "E_CONNECTOR_DRIFT", "W_CONNECTOR_DRIFT"}
    | {"W_CONNECTOR_FEATURE"}
)
SIZE: Final = frozenset(
    {
        "E_SCALE",
        "W_SCALE",
        "W_PART_SCALE",
        "W_BORE_NARROW",
        "W_DIMENSION_SIGN",
        "E_ENVELOPE",
        "E_NOT_ONE_SOLID",
        "E_INVALID_SOLID",
        "E_EMPTY_SOLID",
        "E_SCRIPT_ERROR",
        "E_NOT_EDITABLE",
    }
)
CLASH: Final = frozenset({"E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP", "E_MOTION_COLLISION", "E_FIT_TIGHT", "E_FIT_CONTACT"})
APART: Final = frozenset({"E_FLOATING", "E_NOT_TOUCHING", "E_FIT_LOOSE", "E_FIT_CONTACT", "W_FIT_NOMINAL"})
HELD: Final = frozenset({"W_JOINT_NOT_MADE", "W_JOINT_PARTLY_MADE", "W_JOINT_LEAVES", "W_JOINT_SHORT"})
LIMITS: Final = frozenset(
    {"E_LIMITS_ORDER", "E_LIMITS_KIND", "E_LIMITS_MISSING", "W_LIMITS_EQUAL", "W_LIMITS_UNITS", "E_REST_OUTSIDE_LIMITS"}
)
LOOPS: Final = frozenset(
    {"E_LOOP_OPEN", "E_LOOP_LOCKED", "E_LOOP_LIMIT", "E_DEAD_POINT", "E_SINGULAR", "W_LOOP_INEXACT", "W_SHAKY", "W_NEAR_SINGULAR"}
)
GRAPH: Final = frozenset(
    {"E_DISCONNECTED", "E_JOINT_SELF", "E_JOINT_DUP", "E_NOT_TREE", "E_DOF_MISMATCH", "E_DRIVER", "W_DRIVER", "E_CONNECTOR_UNKNOWN"}
    | {"W_CONNECTOR_UNUSED", "W_DUP_CONNECTOR_USE", "W_CONNECTOR_KIND", "E_DERIVE_JOINT", "E_NO_CONNECTORS", "W_MIRROR_LIMITS"}
)
COUPLED: Final = frozenset({"E_COUPLING", "E_COUPLING_AXES", "E_COUPLING_RATIO", "E_COUPLING_REST", "E_COUPLING_LOCKED"})

_PLACED: Final = PLACE | CLASH | APART | HELD | LOOPS
_SIZED: Final = SIZE | _PLACED
_MOVING: Final = ("angle_deg", "travel_mm", "x_mm", "y_mm", "a_deg", "b_deg")
_HOLLOW, _THICK, _WALL = (
    ("bore", "hole", "slot", "groove", "socket"),
    ("pin", "shaft", "spigot", "tongue", "rod"),
    ("wall", "thick", "board", "floor"),
)


def _times(value: Any, factor: float) -> Any:
    return f"({value}) * {factor}" if isinstance(value, str) else value * factor


def _plus(value: Any, shift: float) -> Any:
    return f"({value}) + {shift}" if isinstance(value, str) else value + shift


def _minus(value: Any) -> Any:
    return f"-({value})" if isinstance(value, str) else -value


def _entry(plan: Json, room: str, name: str) -> Any:
    return next(entry for entry in plan[room] if entry["name"] == name)


def _own_parts(plan: Json) -> list[Json]:
    return [part for part in plan["parts"] if "derive" not in part]


def _copies(plan: Json, name: str) -> set[str]:
    """Return a part with all parts that are derived from it."""
    names = {name}
    for _ in plan["parts"]:
        names |= {part["name"] for part in plan["parts"] if part.get("derive", {}).get("from") in names}
    return names


def _joints_at(plan: Json, part: str, connector: str) -> set[str]:
    ends = {f"{name}.{connector}" for name in _copies(plan, part)}
    return {joint["name"] for joint in plan["joints"] if ends & {joint["parent"], joint["child"]}}


def _of_part(plan: Json, part: str) -> frozenset[str]:
    copies = _copies(plan, part)
    joints = {joint["name"] for joint in plan["joints"] if copies & {joint[end].split(".")[0] for end in ("parent", "child")}}
    return frozenset(copies | joints)


def _of_joint(plan: Json, joint: Json) -> frozenset[str]:
    derived = {one["name"] for one in plan["joints"] if one.get("derive", {}).get("from") == joint["name"]}
    ends = {joint[end].split(".")[0] for end in ("parent", "child")}
    return frozenset({joint["name"], *derived, *ends, *_coupled(plan, {joint["name"]})})


def _coupled(plan: Json, joints: set[str]) -> set[str]:
    """Return the couplings of some joints."""
    return {one["name"] for one in plan.get("couplings", ()) if joints & {name.split(".")[0] for name in one["joints"]}}


# ---------------------------------------------------------------- numbers


def _scaled(factor: float, words: tuple[str, ...], product: Product) -> Iterator[Site]:
    """Multiply one length among the dimensions, if its name has one of the words."""
    for part in _own_parts(product.plan):
        for name, value in part.get("dimensions", {}).items():
            if name.endswith(("_deg", "_count")) or value == 0 or (words and not any(word in name for word in words)):
                continue

            def change(plan: Json, part: str = part["name"], name: str = name) -> None:
                dimensions = _entry(plan, "parts", part)["dimensions"]
                dimensions[name] = _times(dimensions[name], factor)

            yield Site(f"parts.{part['name']}.dimensions.{name} × {factor:g}", _of_part(product.plan, part["name"]) | {name}, change)


def _set_to(value: float, words: tuple[str, ...], product: Product) -> Iterator[Site]:
    """Set one dimension to a number, if its name has one of the words."""
    for part in _own_parts(product.plan):
        for name in part.get("dimensions", {}):
            if any(word in name for word in words) and not name.endswith(("_deg", "_count")):

                def change(plan: Json, part: str = part["name"], name: str = name) -> None:
                    _entry(plan, "parts", part)["dimensions"][name] = value

                yield Site(f"parts.{part['name']}.dimensions.{name} = {value:g}", _of_part(product.plan, part["name"]) | {name}, change)


def _parameter(factor: float, product: Product) -> Iterator[Site]:
    """Multiply a parameter that has a number."""
    for parameter in product.plan.get("parameters", ()):
        if isinstance(parameter["value"], str) or parameter.get("unit", "mm") != "mm" or parameter["value"] == 0:
            continue

        def change(plan: Json, name: str = parameter["name"]) -> None:
            entry = _entry(plan, "parameters", name)
            entry["value"] = _times(entry["value"], factor)

        yield Site(f"parameters.{parameter['name']} × {factor:g}", _users(product.plan, parameter["name"]), change)


def _users(plan: Json, name: str) -> frozenset[str]:
    """Return a parameter with the parameters, parts and joints whose numbers follow from it."""
    names = {name}

    def follows(value: object) -> bool:
        return not names.isdisjoint(re.findall(r"[a-z_][a-z0-9_]*", str(value)))

    for _ in plan["parameters"]:
        names |= {parameter["name"] for parameter in plan["parameters"] if follows(parameter["value"])}
    parts = {
        copy
        for part in plan["parts"]
        if follows({**part, "description": "", "name": "", "role": ""})
        for copy in _copies(plan, part["name"])
    }
    joints = {joint["name"] for joint in plan["joints"] if follows({key: joint.get(key) for key in (*_MOVING, "rest_deg", "rest_mm")})}
    at_parts = {joint["name"] for joint in plan["joints"] if parts & {joint[end].split(".")[0] for end in ("parent", "child")}}
    return frozenset(names | parts | joints | at_parts)


def _density(product: Product) -> Iterator[Site]:
    for material in product.plan["materials"]:

        def change(plan: Json, name: str = material["name"]) -> None:
            entry = _entry(plan, "materials", name)
            entry["density_kg_m3"] = _times(entry["density_kg_m3"], 0.001)

        yield Site(f"materials.{material['name']}.density_kg_m3 × 0.001", frozenset({material["name"]}), change)


def _envelope(product: Product) -> Iterator[Site]:
    for part in _own_parts(product.plan):
        sizes = part.get("envelope_mm")
        if sizes and sizes[0] != sizes[2]:

            def change(plan: Json, name: str = part["name"]) -> None:
                _entry(plan, "parts", name)["envelope_mm"].reverse()

            yield Site(f"parts.{part['name']}.envelope_mm: x and z exchanged", _of_part(product.plan, part["name"]), change)


# ---------------------------------------------------------------- places and axes

_Change = Callable[[Json], object]


def _connector(said: str, edit: _Change, product: Product) -> Iterator[Site]:
    """Change one connector that a joint uses."""
    for part in _own_parts(product.plan):
        for connector in part.get("connectors", ()):
            joints = _joints_at(product.plan, part["name"], connector["name"])
            if joints:

                def change(plan: Json, part: str = part["name"], name: str = connector["name"]) -> None:
                    edit(next(one for one in _entry(plan, "parts", part)["connectors"] if one["name"] == name))

                coupled = _coupled(product.plan, joints)
                names = frozenset({part["name"], connector["name"]} | joints | coupled | _copies(product.plan, part["name"]))
                yield Site(f"parts.{part['name']}.connectors.{connector['name']}: {said}", names, change)


def _joint_axis(said: str, edit: _Change, product: Product) -> Iterator[Site]:
    """Change both connectors of a joint that moves: the plan agrees with itself, but the axis is elsewhere than the surfaces."""
    own = {part["name"] for part in _own_parts(product.plan)}
    for joint in product.plan["joints"]:
        ends = [joint[end].split(".") for end in ("parent", "child")]
        if "derive" in joint or joint["type"] == "fixed" or any(part not in own for part, _ in ends):
            continue
        frames = [next(one for one in _entry(product.plan, "parts", part)["connectors"] if one["name"] == name) for part, name in ends]
        turned = [_entry(product.plan, "parts", part).get("rest_pose", {}) for part, _ in ends]
        if any(frame.get("frame") == "assembly" for frame in frames) or any(pose == "auto" or "angle_deg" in pose for pose in turned):
            continue  # the same change has to mean the same in both frames

        def change(plan: Json, ends: list[list[str]] = ends) -> None:
            for part, name in ends:
                edit(next(one for one in _entry(plan, "parts", part)["connectors"] if one["name"] == name))

        yield Site(f"joints.{joint['name']}, both connectors: {said}", _of_joint(product.plan, joint), change)


def _shifted(by: float, connector: Json) -> None:
    """Shift across the axis: along x, or along y where the axis is x."""
    place = 1 if connector["z"][0] not in (0, 0.0) else 0
    connector["o"][place] = _plus(connector["o"][place], by)


def _reversed(connector: Json) -> None:
    connector["z"] = [_minus(value) for value in connector["z"]]


def _cycled(connector: Json) -> None:
    connector["z"] = connector["z"][-1:] + connector["z"][:-1]
    if "x" in connector:
        connector["x"] = connector["x"][-1:] + connector["x"][:-1]


def _quarter(connector: Json) -> None:
    """Turn about z by a quarter: x becomes z × x."""
    z, x = connector["z"], connector["x"]
    connector["x"] = [f"({z[i - 2]}) * ({x[i - 1]}) - ({z[i - 1]}) * ({x[i - 2]})" for i in range(3)]


def _rolled(product: Product) -> Iterator[Site]:
    for site in _connector("x turned by 90°", _quarter, product):
        _, part, _, name = site.said.split(":")[0].split(".")
        connector = next(one for one in _entry(product.plan, "parts", part)["connectors"] if one["name"] == name)
        if "x" in connector:
            yield site


def _pose(by: float, product: Product) -> Iterator[Site]:
    for part in _own_parts(product.plan):
        if part.get("rest_pose", {}) == "auto" or part["name"] == product.plan["ground"]:
            continue

        def change(plan: Json, name: str = part["name"]) -> None:
            pose = _entry(plan, "parts", name).setdefault("rest_pose", {})
            at = pose.setdefault("at", [0, 0, 0])
            at[2] = _plus(at[2], by)

        yield Site(f"parts.{part['name']}.rest_pose: {by:g} mm along z", _of_part(product.plan, part["name"]), change)


def _mirror_plane(product: Product) -> Iterator[Site]:
    for part in product.plan["parts"]:
        if part.get("derive", {}).get("op") == "mirror":

            def change(plan: Json, name: str = part["name"]) -> None:
                plane = _entry(plan, "parts", name)["derive"]["plane"]
                plane["normal"] = plane["normal"][-1:] + plane["normal"][:-1]

            yield Site(f"parts.{part['name']}.derive.plane: another normal", _of_part(product.plan, part["name"]), change)


def _copy_place(product: Product) -> Iterator[Site]:
    for part in product.plan["parts"]:
        derive = part.get("derive", {})
        key = {"rigid": "move", "pattern": "step"}.get(derive.get("op", ""))
        if key and "at" in derive[key]:

            def change(plan: Json, name: str = part["name"], key: str = key) -> None:
                pose = _entry(plan, "parts", name)["derive"][key]
                pose["at"] = [_minus(value) for value in pose["at"]]

            names = frozenset({part["name"]}) | _of_part(product.plan, part["name"]) | {f"{part['name']}_{k}" for k in range(1, 40)}
            yield Site(f"parts.{part['name']}.derive.{key}: sign", names, change)


# ---------------------------------------------------------------- joints


def _joint(said: str, edit: Callable[[Json, Json], object], fits: Callable[[Json], bool], product: Product) -> Iterator[Site]:
    """Change one joint that is not derived and for which a condition holds; `edit` gets the joint and the plan."""
    for joint in product.plan["joints"]:
        if "derive" not in joint and fits(joint):

            def change(plan: Json, name: str = joint["name"]) -> None:
                edit(_entry(plan, "joints", name), plan)

            yield Site(f"joints.{joint['name']}: {said}", _of_joint(product.plan, joint), change)


def _range_key(joint: Json) -> str | None:
    return next((key for key in _MOVING if isinstance(joint.get(key), list)), None)


def _lopsided(joint: Json) -> bool:
    """Whether the limits are not symmetric: only then is their sign a mistake."""
    key = _range_key(joint)
    return key is not None and str(joint[key][0]) != str(_minus(joint[key][1])) and str(joint[key][1]) != str(_minus(joint[key][0]))


def _edited_range(of: Callable[[list[Any]], list[Any]], joint: Json, _plan: Json) -> None:
    key = _range_key(joint)
    assert key is not None
    joint[key] = of(joint[key])


def _is_angle(joint: Json) -> bool:
    return _range_key(joint) in ("angle_deg", "a_deg")


def _is_travel(joint: Json) -> bool:
    return _range_key(joint) == "travel_mm"


def _has_range(joint: Json) -> bool:
    return _range_key(joint) is not None


def _moves(joint: Json) -> bool:
    return bool(joint["type"] != "fixed")


def _any(_joint: Json) -> bool:
    return True


def _has_fit(joint: Json) -> bool:
    return isinstance(joint.get("fit"), dict) and "gap_mm" in joint["fit"]


def _fixed(joint: Json, _plan: Json) -> None:
    kept: Json = {key: joint[key] for key in ("name", "parent", "child", "mate") if key in joint}
    joint.clear()
    joint.update(kept, type="fixed")


def _fit_at(low: float, high: float, joint: Json, _plan: Json) -> None:
    joint["fit"]["gap_mm"] = [low, high]


def _opposite(joint: Json, _plan: Json) -> None:
    joint["mate"] = "aligned" if joint.get("mate") == "opposed" else "opposed"


def _other_parent(product: Product) -> Iterator[Site]:
    """Join a part to a connector of a third part."""
    for joint in product.plan["joints"]:
        parent, child = (joint[end].split(".")[0] for end in ("parent", "child"))
        for part in _own_parts(product.plan):
            if part["name"] in (parent, child) or "derive" in joint:
                continue
            for connector in part.get("connectors", ()):

                def change(plan: Json, name: str = joint["name"], to: str = f"{part['name']}.{connector['name']}") -> None:
                    _entry(plan, "joints", name)["parent"] = to

                names = _of_joint(product.plan, joint) | {part["name"]}
                yield Site(f"joints.{joint['name']}.parent: {part['name']}.{connector['name']}", names, change)


def _missing_joint(product: Product) -> Iterator[Site]:
    sources = {joint["derive"]["from"] for joint in product.plan["joints"] if "derive" in joint}
    coupled = {name.split(".")[0] for one in product.plan.get("couplings", ()) for name in one["joints"]}
    for joint in product.plan["joints"]:
        if joint["name"] not in sources | coupled:

            def change(plan: Json, name: str = joint["name"]) -> None:
                plan["joints"] = [one for one in plan["joints"] if one["name"] != name]

            yield Site(f"joints.{joint['name']} is missing", _of_joint(product.plan, joint), change)


def _swapped_parts(product: Product) -> Iterator[Site]:
    """Exchange the rest poses of two parts."""
    own = [part for part in _own_parts(product.plan) if part.get("rest_pose", {}) != "auto"]
    for k, first in enumerate(own):
        for second in own[k + 1 :]:
            if first.get("rest_pose", {}) != second.get("rest_pose", {}):

                def change(plan: Json, a: str = first["name"], b: str = second["name"]) -> None:
                    one, other = _entry(plan, "parts", a), _entry(plan, "parts", b)
                    one["rest_pose"], other["rest_pose"] = other.get("rest_pose", {}), one.get("rest_pose", {})

                names = _of_part(product.plan, first["name"]) | _of_part(product.plan, second["name"])
                yield Site(f"rest poses of {first['name']} and {second['name']} exchanged", names, change)


def _freedoms(_product: Product) -> Iterator[Site]:
    def change(plan: Json) -> None:
        plan["freedoms"] += 1

    yield Site("freedoms + 1", frozenset({"freedoms"}), change)


def _no_driver(product: Product) -> Iterator[Site]:
    for joint in product.plan["joints"]:
        if joint.get("driver"):

            def change(plan: Json, name: str = joint["name"]) -> None:
                del _entry(plan, "joints", name)["driver"]

            names = frozenset({"drivers", "joints", "plan"}) | {one["name"] for one in product.plan["joints"]}
            yield Site(f"joints.{joint['name']} is no driver", names, change)


def _unknown_connector(joint: Json, _plan: Json) -> None:
    joint["child"] += "s"


def _coupling(said: str, edit: _Change, product: Product) -> Iterator[Site]:
    for coupling in product.plan.get("couplings", ()):

        def change(plan: Json, name: str = coupling["name"]) -> None:
            edit(_entry(plan, "couplings", name))

        joints = {name.split(".")[0] for name in coupling["joints"]}
        names = {coupling["name"], *joints}
        for joint in product.plan["joints"]:
            names |= _of_joint(product.plan, joint) if joint["name"] in joints else set()
        yield Site(f"couplings.{coupling['name']}: {said}", frozenset(names), change)


def _other_ratio(coupling: Json) -> None:
    if "ratio" in coupling:
        coupling["ratio"] = _times(coupling["ratio"], 2)
    elif "lead_mm" in coupling:
        coupling["lead_mm"] = _times(coupling["lead_mm"], 2)
    elif isinstance(coupling.get("teeth"), list):
        coupling["teeth"].reverse()
    elif "teeth" in coupling:
        coupling["teeth"] = _times(coupling["teeth"], 2)
    else:
        coupling["radii_mm"].reverse()


def _other_sign(coupling: Json) -> None:
    if "ratio" in coupling:
        coupling["ratio"] = _minus(coupling["ratio"])
    elif "lead_mm" in coupling:
        coupling["lead_mm"] = _minus(coupling["lead_mm"])
    else:
        coupling["internal"] = not coupling.get("internal", False)


def _kind(
    name: str, meaning: str, causes: frozenset[str], sites: Callable[..., Iterator[Site]], *given: Any, misplaces: bool = False
) -> Kind:
    return Kind(name, "plan", meaning, FORM | causes, partial(sites, *given), misplaces)


PLAN_KINDS: Final = (
    _kind("unit_thousand", "a dimension is in micrometres: × 1000", _SIZED, _scaled, 1000.0, ()),
    _kind("unit_thousandth", "a dimension is in metres: × 0.001", _SIZED, _scaled, 0.001, ()),
    _kind("unit_inch", "a dimension is in inches: ÷ 25.4", _SIZED, _scaled, 1 / 25.4, ()),
    _kind("parameter_thousand", "a parameter × 1000", _SIZED | LIMITS | {"E_PARAMETER_BOUNDS"}, _parameter, 1000.0),
    _kind("parameter_inch", "a parameter ÷ 25.4", _SIZED | LIMITS | {"E_PARAMETER_BOUNDS"}, _parameter, 1 / 25.4),
    _kind("density_unit", "a density in g/cm³", frozenset({"E_DENSITY", "W_DENSITY"}), _density),
    _kind("slot_small", "a bore, slot or groove × 0.8", _SIZED, _scaled, 0.8, _HOLLOW),
    _kind("pin_thick", "a pin, shaft or tongue × 1.25", _SIZED, _scaled, 1.25, _THICK),
    _kind("wall_thin", "a wall or board of 0.01 mm", _SIZED, _set_to, 0.01, _WALL),
    _kind("size_negative", "a dimension with the wrong sign", _SIZED, _scaled, -1.0, ()),
    _kind("envelope_turned", "x and z of an envelope exchanged", SIZE, _envelope, misplaces=True),
    _kind("axis_reversed", "z of a connector reversed", _PLACED | LIMITS, _connector, "z reversed", _reversed, misplaces=True),
    _kind(
        "axis_turned",
        "axes of a connector exchanged",
        _PLACED | COUPLED | {"E_AXIS_PARALLEL"},
        _connector,
        "axes exchanged",
        _cycled,
        misplaces=True,
    ),
    _kind("roll_turned", "x of a connector turned by 90°", _PLACED, _rolled, misplaces=True),
    _kind("origin_off_1", "a connector off by 1 mm", _PLACED, _connector, "1 mm off", partial(_shifted, 1.0), misplaces=True),
    _kind("origin_off_5", "a connector off by 5 mm", _PLACED, _connector, "5 mm off", partial(_shifted, 5.0), misplaces=True),
    _kind("origin_off_50", "a connector off by 50 mm", _PLACED, _connector, "50 mm off", partial(_shifted, 50.0), misplaces=True),
    _kind(
        "joint_off_1", "both connectors of a joint off by 1 mm", _PLACED, _joint_axis, "1 mm off", partial(_shifted, 1.0), misplaces=True
    ),
    _kind(
        "joint_off_5", "both connectors of a joint off by 5 mm", _PLACED, _joint_axis, "5 mm off", partial(_shifted, 5.0), misplaces=True
    ),
    _kind("joint_reversed", "both z of a joint reversed", _PLACED | LIMITS, _joint_axis, "z reversed", _reversed, misplaces=True),
    _kind("joint_turned", "both axes of a joint exchanged", _PLACED | COUPLED, _joint_axis, "axes exchanged", _cycled, misplaces=True),
    _kind("pose_off", "a part 5 mm off at rest", _PLACED, _pose, 5.0),
    _kind("mirror_plane", "a mirror plane with another normal", _PLACED | {"E_DERIVE_JOINT"}, _mirror_plane),
    _kind("copy_place", "a copy on the other side", _PLACED, _copy_place),
    _kind("parts_swapped", "rest poses of two parts exchanged", _PLACED, _swapped_parts),
    _kind(
        "limit_sign",
        "limits with the wrong sign",
        LIMITS | _PLACED,
        _joint,
        "limits negated",
        partial(_edited_range, lambda r: [_minus(r[1]), _minus(r[0])]),
        _lopsided,
    ),
    _kind(
        "limit_order", "limits exchanged", LIMITS, _joint, "limits exchanged", partial(_edited_range, lambda r: [r[1], r[0]]), _has_range
    ),
    _kind(
        "limit_radians",
        "limits in radians",
        LIMITS | LOOPS,
        _joint,
        "limits in radians",
        partial(_edited_range, lambda r: [_times(v, 0.0174533) for v in r]),
        _is_angle,
    ),
    _kind(
        "travel_long",
        "a travel × 3",
        LIMITS | _PLACED,
        _joint,
        "travel × 3",
        partial(_edited_range, lambda r: [_times(v, 3) for v in r]),
        _is_travel,
    ),
    _kind("joint_fixed", "a moving joint is fixed", GRAPH | PLACE | LOOPS | COUPLED, _joint, "fixed", _fixed, _moves),
    _kind("mate_opposed", "the other mate", _PLACED, _joint, "the other mate", _opposite, _any),
    _kind("parent_wrong", "a joint to another part", GRAPH | PLACE | LOOPS, _other_parent),
    _kind("joint_missing", "a joint is missing", GRAPH | APART | LOOPS | COUPLED, _missing_joint),
    _kind(
        "connector_unknown",
        "a joint to a connector that does not exist",
        GRAPH | {"E_DERIVE_JOINT"},
        _joint,
        "unknown connector",
        _unknown_connector,
        _any,
    ),
    _kind("freedoms_wrong", "freedoms declared wrong", frozenset({"E_DOF_MISMATCH"}), _freedoms),
    _kind("driver_missing", "a driver is not marked", frozenset({"E_DRIVER"}), _no_driver),
    _kind("ratio_wrong", "a coupling with another ratio", COUPLED | CLASH | LOOPS, _coupling, "another ratio", _other_ratio),
    _kind("ratio_sign", "a coupling with the other sense", COUPLED | CLASH | LOOPS, _coupling, "the other sense", _other_sign),
    _kind(
        "fit_impossible",
        "a fit whose least gap exceeds its greatest",
        frozenset({"E_FIT"}),
        _joint,
        "gap [1, 0.1]",
        partial(_fit_at, 1.0, 0.1),
        _has_fit,
    ),
    _kind("fit_narrow", "a fit that the parts do not keep", CLASH | APART, _joint, "gap [2, 3]", partial(_fit_at, 2.0, 3.0), _has_fit),
)
