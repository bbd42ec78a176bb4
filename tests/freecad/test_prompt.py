"""The prompt about FreeCAD lists exactly the functions that exist, and other tests build a script that uses all of them."""

from __future__ import annotations

import ast
import re
from importlib.resources import files
from pathlib import Path

import pytest

from articad import memory
from articad.kernels import freecad_install

ROOT = Path(__file__).resolve().parents[2]
PROMPTS = files("articad.agents.prompts")
PROMPT = (PROMPTS / "part_freecad.md").read_text()
AUTHORING = Path(freecad_install.__file__).parent / "inside_freecad" / "part.py"
BUILT = [
    *ROOT.glob("examples/*/parts/*.freecad.py"),
    *Path(memory.__file__).parent.glob("snippets/freecad/*.py"),
    Path(__file__).with_name("test_kernel.py"),
]
NAMED = sorted(set(re.findall(r"part\.([a-z_]+)\(", PROMPT)))


def methods() -> dict[str, ast.arguments]:
    """Return the arguments of the functions that a script finds in `part`."""
    tree = ast.parse(AUTHORING.read_text())
    (offered,) = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Authoring"]
    return {node.name: node.args for node in offered.body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")}


def test_every_function_of_the_prompt_exists_and_none_is_kept_from_it() -> None:
    served = {"body", "number", "length", "angle"}  # numbers serve the others
    assert set(NAMED) | served | {"made"} == set(methods())  # the plans of the prompt have no standard joints


def test_the_keywords_of_the_prompt_exist() -> None:
    for name, told in re.findall(r"part\.([a-z_]+)\(([^#\n]*)\)", PROMPT):
        known = {argument.arg for argument in (*methods()[name].args, *methods()[name].kwonlyargs)}
        assert set(re.findall(r"\b([a-z_]+)=", told)) <= known, name


@pytest.mark.parametrize("name", NAMED)
def test_every_function_of_the_prompt_is_run_by_a_script_that_is_built(name: str) -> None:
    assert any(f"part.{name}(" in path.read_text() for path in BUILT)


def test_the_example_of_the_prompt_is_a_part_of_an_example() -> None:
    assert (PROMPTS / "door_left_freecad.txt").read_text() == (ROOT / "examples/wardrobe/parts/door_left.freecad.py").read_text()
