"""Hints about part scripts, followed literally: the script is changed as the hint says and nothing else, and the finding is gone.

Scripts are templates of one line or a few; what a reader changes are their fields. A hint with alternatives has a rule for each.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from articad.errors import ContractError, KernelError
from articad.findings import Finding, Findings
from articad.kernels.build123d import Build123dKernel
from articad.kernels.kernel import BuildCache
from tests.kernels.conftest import Build, frame
from tests.kernels.test_seating import built, plan, script
from tests.obedience import worse

Fields = dict[str, Any]
Follow = Callable[[Fields, re.Match[str]], Fields]
NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
HERE = "{'a': {'o': (0, 0, 0), 'z': (0, 0, 1)}}"


@dataclass(frozen=True)
class Case:
    """A script with a fault, what it was ordered, and what a reader of its hint changes."""

    code: str
    script: str
    fields: Fields
    rules: list[tuple[str, Follow]]
    brief: Fields = field(default_factory=dict)
    probe: bool = False


def by(name: str, sign: float) -> Follow:
    return lambda fields, match: {name: fields[name] + sign * float(match[1])}


def text(name: str, value: str) -> Follow:
    """Replace a field by a text that may hold groups of the match."""
    return lambda _fields, match: {name: match.expand(value) if "\\" in value else value}


A = {"connectors": {"a": frame()}}
FAR = {"connectors": {"a": frame(joints=[{"name": "j", "type": "fixed"}]), "b": frame((30, 0, 5))}}
BOTH = {"a": "'a': {'o': (0, 0, 0), 'z': (0, 0, 1), 'x': (1, 0, 0)}"}
RETURN_PAIR = r"Define build\(part\) and return \(shape, \{name: \{'o': …, 'z': …, 'x': …\}\}\)"

CASES = [
    Case(
        "E_ENVELOPE",
        "return Box({x}, 20, 5), {{}}",
        {"x": 12.0},
        [(rf"{NUMBER} mm shorter along x", by("x", -1))],
        {"envelope_mm": [10, 20, 5]},
    ),
    Case(
        "E_ENVELOPE",
        "return Box(10, {y}, 5), {{}}",
        {"y": 17.0},
        [(rf"{NUMBER} mm longer along y", by("y", 1))],
        {"envelope_mm": [10, 20, 5]},
    ),
    Case(
        "E_NOT_ONE_SOLID",
        "return Box(9, 9, 9) + Pos(9 - {lap}, 9 - {lap}, 0) * Box(9, 9, 9), {{}}",
        {"lap": 0.0},
        [(rf"overlap by at least {NUMBER} mm", by("lap", 1))],
    ),
    Case(
        "E_NOT_ONE_SOLID",
        "return Box(9, 9, 9) + Pos(20, 0, 0) * Box(9, 9, 9){of}, {{}}",
        {"of": ""},
        [("return the solid alone", text("of", " & Box(12, 12, 12)"))],
    ),
    Case(
        "E_EMPTY_SOLID",
        "return Box(9, 9, 9){cut}, {{}}",
        {"cut": " - Box(10, 10, 10)"},
        [("cuts do not remove everything", text("cut", ""))],
    ),
    Case(
        "E_EMPTY_SOLID",
        "return extrude(Rectangle(0.1, 0.1), {high}), {{}}",
        {"high": 0.01},
        [("extrusions have a positive height", lambda _f, _m: {"high": 10.0})],
    ),
    Case(
        "E_CONNECTOR_MISSING",
        "return Box(9, 9, 9), {{{entries}}}",
        {"entries": BOTH["a"]},
        [
            (
                r'Return "(\w+)": \{"o": ….* the plan has it at (\([^)]*\))',
                text("entries", BOTH["a"] + r", '\1': {'o': \2, 'z': (0, 0, 1), 'x': (1, 0, 0)}"),
            )
        ],
        FAR,
    ),
    Case(
        "E_CONNECTOR_EXTRA",
        "found = {{'a': {{'o': (0, 0, 0), 'z': (0, 0, 1)}}, 'c': {{'o': (0, 0, 0), 'z': (0, 0, 1)}}}}\n"
        "return Box(9, 9, 9), {{name: found[name] for name in {names}}}",
        {"names": "('a', 'c')"},
        [(r"Return only (\w+)\.", text("names", r"('\1',)"))],
        A,
    ),
    Case("E_NO_BUILD", "return Box(9, 9, 9){pair}", {"pair": ""}, [(RETURN_PAIR, text("pair", f", {HERE}"))], A),
    Case(
        "E_NO_BUILD",
        "return Box(9, 9, 9), {{'a': {{'o': (0, 0, 0), 'z': (0, 0, 1), 'x': {x}}}}}",
        {"x": "(0, 0, 2)"},
        [(r"(?:such as|Did you mean x=|Set x to|Choose x) ?(\([^)]*\))", text("x", r"\1"))],
        A,
    ),
    Case(
        "E_SCRIPT_ERROR", "width = {value}\nreturn Box(width, 9, 9), {{}}", {"value": "9 / 0"}, [("Correct this line", text("value", "9"))]
    ),
    Case(
        "E_SCRIPT_ERROR",
        "{end}return Box(9, 9, 9), {{}}",
        {"end": "import os\nos._exit(0)\n"},
        [(r"Return from build\(part\)", text("end", ""))],
    ),
    Case(
        "W_DIMENSION_REFUSED",
        "if d['w'] {limit}:\n    raise ValueError('the shelf would sag')\nreturn Box(d['w'], 9, 9), {{}}",
        {"limit": "!= 10"},
        [("Let the script accept what can be built", text("limit", "> 1000"))],
        {"dimensions": {"w": 10.0}},
        probe=True,
    ),
    Case(
        "E_SCRIPT_FORBIDDEN",
        "{line}return Box(9, 9, 9), {{}}",
        {"line": "open('/etc/hostname')\n"},
        [("no files", text("line", ""))],
    ),
    Case(
        "E_SCRIPT_MEMORY", "x = [0] * {many}\nreturn Box(9, 9, 9), {{}}", {"many": "(1 << 40)"}, [("Use fewer copies", text("many", "9"))]
    ),
    Case(
        "W_DIMENSION_UNUSED",
        "return Box({width}, 9, 9), {{}}",
        {"width": "10"},
        [("Use it in the geometry, perhaps where a literal number stands", text("width", "d['w']"))],
        {"dimensions": {"w": 10.0}},
        probe=True,
    ),
    Case(
        "W_DIMENSION_UNUSED",
        "return Box(10, 9, 9) + Pos(0, 0, {up}) * Cylinder(1, d['w']), {{}}",
        {"up": "0"},
        [("Let what it sizes reach the surface", text("up", "4"))],
        {"dimensions": {"w": 4.0}},
        probe=True,
    ),
    Case(
        "E_NOT_EDITABLE",
        "return {{10.0: Box(d['w'], 9, 9)}}[{x}], {{}}",
        {"x": "d['w']"},
        [("so that it follows its dimensions", text("x", "10.0"))],
        {"dimensions": {"w": 10.0}},
        probe=True,
    ),
]


def outcome(build: Build, case: Case, fields: Fields) -> Findings:
    try:
        return build(case.script.format(**fields), probe=case.probe, **case.brief).findings
    except KernelError as error:
        return error.findings


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.script[:24]}")
def test_a_script_changed_as_the_hint_says_has_the_finding_no_more(build: Build, case: Case) -> None:
    found = outcome(build, case, case.fields).of(case.code)
    assert found, str(outcome(build, case, case.fields))
    for words, change in case.rules:
        match = re.search(words, found[0].hint)
        assert match, found[0].hint
        after = outcome(build, case, {**case.fields, **change(case.fields, match)})
        assert not after.of(case.code), f"{found[0].hint}\n{after}"
        assert not worse(outcome(build, case, case.fields), after), f"{found[0].hint}\n{after}"


@pytest.mark.parametrize(
    ("shift", "code"), [("Pos(0.5, 0, 0)", "W_CONNECTOR_DRIFT"), ("Pos(8, 0, 0) * Rot(0, 20, 0)", "E_CONNECTOR_DRIFT")]
)
def test_a_feature_built_at_the_frame_of_the_hint_drifts_no_more(kernel: Build123dKernel, tmp_path: Path, shift: str, code: str) -> None:
    def drifts(source: bytes) -> tuple[Finding, ...]:
        try:
            return built(plan(), source, kernel, BuildCache(tmp_path / "cache"))[2].of(code)
        except ContractError as error:
            return error.findings.of(code)

    (finding,) = drifts(script(latch=shift))
    told = re.search(r"Build the feature at o (\(.*?\)), z (\(.*?\)), x (\(.*?\))\.", finding.hint)
    assert told, finding.hint
    o, z, x = told.groups()
    frame_of_hint = f"Plane({o}, x_dir={x}, z_dir={z}).location"
    assert not drifts(script(latch=f"Plane((50, 0, 10), x_dir=(1, 0, 0), z_dir=(0, 1, 0)).location.inverse() * {frame_of_hint}"))
