"""Reading what models say: JSON and scripts with fences, words and accidents around them."""

from __future__ import annotations

import random
import re
import time

import pytest

from articad.agents import replies
from articad.agents.prompts import prompt
from articad.agents.replies import object_text, parse_object, parse_script
from articad.errors import OutputError

SCRIPT = "import math\n\n\ndef build(part):\n    return None, {}\n"


@pytest.mark.parametrize(
    "text",
    [
        '{"a": [1, 2]}',
        '\n  {"a": [1, 2]}\n',
        '```json\n{"a": [1, 2]}\n```',
        'Sure, here it is:\n```\n{"a": [1, 2]}\n```\nAnything else?',
        'The plan is {"a": [1, 2]} as asked.',
    ],
)
def test_an_object_is_found(text: str) -> None:
    assert parse_object(text, step="s") == {"a": [1, 2]}
    assert object_text(text, step="s").strip() == '{"a": [1, 2]}'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1 column 1"),
        ('{"a": 1,}', "not one JSON object"),
        ("[1]", "JSON list"),
        ("3", "JSON number"),
        ("null", "JSON null"),
        ('{"a": 1} {"b": 2}', "Extra data"),
    ],
)
def test_what_is_no_object_is_refused_with_the_place(text: str, words: str) -> None:
    with pytest.raises(OutputError, match=words) as caught:
        parse_object(text, step="design/1")
    assert caught.value.raw == text
    assert caught.value.findings.codes == ("E_REPLY_SCHEMA",)
    assert caught.value.findings[0].where == "llm.design/1"


@pytest.mark.parametrize(
    "text",
    [
        f"```python\n{SCRIPT}```",
        f"Here:\n\n```python\n{SCRIPT}```\nIt has a bore.",
        f"```py\n{SCRIPT}\n\n```",
        SCRIPT,
        f"```python\n{SCRIPT}",
        f"First install:\n```\npip install build123d\n```\nthen\n```python\n{SCRIPT}```",
        f"```python\ndef build(part):\n    return 1\n```\nNo, better:\n```python\n{SCRIPT}```",
    ],
)
def test_a_script_is_found(text: str) -> None:
    assert parse_script(text, step="part/x/1") == SCRIPT.encode()


@pytest.mark.parametrize("text", ["", "no", "```python\nprint(1)\n```", "```json\n{}\n```"])
def test_what_is_no_script_is_refused(text: str) -> None:
    with pytest.raises(OutputError, match="no ```python block"):
        parse_script(text, step="part/x/1")


def test_a_prompts_blanks_are_filled_once() -> None:
    assert "{{findings}} of {{x}}" in prompt("design_repair", findings="{{findings}} of {{x}}")
    with pytest.raises(KeyError):
        prompt("design_repair")


WHOLE_BLOCK = re.compile(r"^[ \t]*```[ \t]*([\w+-]*)[^\n]*\n(.*?)^[ \t]*```[ \t]*$", re.DOTALL | re.MULTILINE)
"""What a fenced block is; the search takes quadratic time."""


def test_fenced_blocks_are_those_that_one_expression_describes() -> None:
    choice = random.Random(1).choice
    for _ in range(500):
        text = "".join(choice(["```", "```py", "``` ", "\n", "\n", " ", "x", "\t```\n", "\r\n"]) for _ in range(20))
        assert list(replies._fenced(text)) == WHOLE_BLOCK.findall(text)


@pytest.mark.parametrize("text", ["```a\n" * 100_000, "```" + "a" * 300_000, "```\n" + " \n" * 300_000])
def test_a_reply_of_many_fences_takes_linear_time(text: str) -> None:
    began = time.process_time()
    for read in (parse_object, parse_script):
        with pytest.raises(OutputError):
            read(text, step="s")
    assert time.process_time() - began < 5
