"""The project's examples are found by name."""

from __future__ import annotations

import pytest

from articad import examples
from articad.errors import ReadError
from articad.plan.schema import AssemblyPlan


def test_every_example_is_a_plan_with_a_script_for_each_part() -> None:
    assert "desk_lamp" in examples.names()
    for name in examples.names():
        plan = AssemblyPlan.load(examples.folder(name))
        for part in plan.parts:
            assert getattr(part, "derive", None) is not None or (examples.folder(name) / "parts" / f"{part.name}.py").is_file()


def test_a_name_that_is_none_is_told_what_may_have_been_meant() -> None:
    with pytest.raises(ReadError, match="Did you mean 'desk_lamp'"):
        examples.folder("desk_lmp")
