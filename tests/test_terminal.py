"""Plain text off a terminal, one JSON report with --json, findings even with -q."""

from __future__ import annotations

import io
import json
import threading
from typing import Any

import pytest

from articad.commands.summaries import print_exports, print_findings
from articad.commands.terminal import Terminal
from articad.errors import BuildError, PlanError
from articad.export.losses import assumed_finding
from articad.findings import Finding, Findings

ERROR = Finding(code="E_DUP_NAME", where="parts[1]", message="'lid' is used twice.", hint="Rename one.")
WARNING = Finding(code="W_CONNECTOR_UNUSED", where="parts.lid", message="No joint uses 'rim'.", hint="Remove it.")


class Screen(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def terminal(**flags: bool) -> Terminal:
    return Terminal(**flags, out=io.StringIO(), err=io.StringIO())


def out(of: Terminal) -> str:
    assert isinstance(of.out, io.StringIO)
    return of.out.getvalue()


def err(of: Terminal) -> str:
    assert isinstance(of.err, io.StringIO)
    return of.err.getvalue()


def test_off_a_terminal_tables_are_aligned_plain_text() -> None:
    plain = terminal()
    plain.table(["part", "mass"], [("lid", 1.5), ("a [bold] name", 20)], right=(1,))
    assert out(plain).splitlines() == ["part           mass", "lid             1.5", "a [bold] name    20"]


def test_on_a_terminal_names_are_not_markup() -> None:
    watched = Terminal(out=Screen(), err=Screen())
    watched.table(["part"], [("a [bold] name",)])
    assert "a [bold] name" in out(watched)


def test_quiet_prints_errors_only() -> None:
    quiet = terminal(quiet=True)
    quiet.say("hello")
    quiet.table(["a"], [("b",)])
    quiet.findings(Findings([ERROR, WARNING]))
    assert "E_DUP_NAME" in out(quiet)
    assert "hello" not in out(quiet)
    assert "W_CONNECTOR_UNUSED" not in out(quiet)


def test_json_prints_one_report_and_nothing_else() -> None:
    speaking = terminal(as_json=True)
    speaking.say("hello")
    speaking.table(["a"], [("b",)])
    speaking.findings(Findings([ERROR]))
    with speaking.progress("Building", 1) as tell:
        tell("lid", "started")
        tell("lid", "built")
    speaking.finish({"schema": "articad.findings/1", "ok": True, "findings": []})
    assert json.loads(out(speaking))["ok"] is True
    assert err(speaking) == ""


def test_an_error_is_printed_in_full_with_every_finding_and_hint() -> None:
    speaking = terminal()
    speaking.error(PlanError("The plan has errors.", findings=[ERROR, WARNING]))
    assert "articad: The plan has errors." in err(speaking)
    for finding in (ERROR, WARNING):
        assert finding.code in err(speaking)
        assert finding.hint in err(speaking)
    assert out(speaking) == ""


def test_a_message_that_lists_its_findings_does_not_say_them_twice() -> None:
    speaking = terminal()
    speaking.error(PlanError(str(ERROR), findings=[ERROR]))
    assert err(speaking).count("is used twice") == 1


def test_an_error_as_json_holds_its_type_and_findings() -> None:
    speaking = terminal(as_json=True)
    speaking.error(BuildError("box.py failed.", script="box.py", line=3, findings=[]))
    report = json.loads(out(speaking))
    assert report["schema"] == "articad.error/1"
    assert report["error"] == {"type": "BuildError", "stage": "build", "message": "box.py failed."}


def test_a_script_s_own_traceback_is_shown() -> None:
    speaking = terminal()
    speaking.error(BuildError("box.py failed.", traceback="line 3, in build\n    1 / 0"))
    assert "1 / 0" in err(speaking)


def test_a_finding_shows_its_number_against_its_limit() -> None:
    speaking = terminal()
    speaking.findings(
        Findings([Finding(code="E_MATE_ROLL", where="joints.a", message="Rolled.", hint="Turn x.", value=180.0, limit=0.05, unit="deg")])
    )
    assert "(180 against 0.05 deg)" in out(speaking)


def test_a_number_that_the_message_says_is_not_said_twice() -> None:
    speaking = terminal()
    told: dict[str, Any] = {"code": "E_OVERLAP", "where": "parts.a", "hint": "", "unit": "mm", "limit": 0.12}
    speaking.findings(Findings([Finding(**told, message="a and b overlap, 5.3 mm deep.", value=5.3001)]))
    speaking.findings(Findings([Finding(**told, message="a and b overlap, 53 mm³.", value=5.3001)]))
    assert [("against" in line) for line in out(speaking).splitlines()] == [False, True]


def test_of_the_same_fault_of_the_same_parts_the_worst_is_printed() -> None:
    many = [
        Finding(code="E_OVERLAP", where="parts.a", parts=parts, message=f"{depth} mm deep.", hint="", value=depth, limit=0.1, unit="mm")
        for parts, depth in ((("a", "b"), 1.0), (("a", "b"), 3.0), (("a", "b"), 2.0), (("a", "c"), 4.0))
    ]
    speaking, asked = terminal(), terminal(verbose=True)
    for each in (speaking, asked):
        print_findings([finding.to_json() for finding in many], each)
    assert [line for line in out(speaking).splitlines() if "deep" in line] == [
        "  E_OVERLAP parts.a: 3.0 mm deep.",
        "  E_OVERLAP parts.a: 4.0 mm deep.",
    ]
    assert "2 more of these parts" in out(speaking)
    assert out(asked).count("deep") == len(many)


def test_a_finding_that_two_formats_share_is_printed_once() -> None:
    assumed = assumed_finding(["hinge"])[0].to_json()
    export = {"main": "m", "files": {"m": 1}, "rows": [], "findings": [assumed]}
    shown = terminal()

    print_exports({"urdf": export, "mjcf": export}, shown)
    assert (out(shown) + err(shown)).count("I_EFFORT_ASSUMED") == 1


def test_off_a_terminal_progress_is_a_line_for_each_end_from_any_thread() -> None:
    speaking = terminal()
    with speaking.progress("Building", 20) as tell:
        names = [f"part_{number}" for number in range(20)]
        for name in names:
            tell(name, "started")
        threads = [threading.Thread(target=tell, args=(name, "built")) for name in names]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    lines = err(speaking).splitlines()
    assert sorted(line.split(":")[0].strip() for line in lines) == sorted(names)
    assert out(speaking) == ""


def test_what_needed_no_work_is_not_worth_a_line() -> None:
    speaking = terminal()
    with speaking.progress("Building", 2) as tell:
        tell("lid", "cached")
        tell("design", "12 parts, 0 errors")
    assert err(speaking) == "  design: 12 parts, 0 errors\n"


def test_on_a_terminal_progress_is_live_and_leaves_nothing_behind() -> None:
    watched = Terminal(out=Screen(), err=Screen())
    with watched.progress("Building", 2) as tell:
        tell("lid", "started")
        tell("lid", "built")
        tell("box", "derived")
    assert out(watched) == ""


def test_on_a_terminal_what_went_wrong_stays_and_what_was_spent_is_seen() -> None:
    watched = Terminal(out=Screen(), err=Screen())
    with watched.progress("Generating", note=lambda: "3 calls, 1200 tokens, $0.02") as tell:
        tell("design", "started")
        tell("design", "5 parts, 2 errors")
        tell("lid", "started")
        tell("lid", "built")
    assert "design: 5 parts, 2 errors" in err(watched)
    assert "3 calls, 1200 tokens, $0.02" in err(watched)
    assert "lid: built" not in err(watched)


def test_off_a_terminal_a_short_step_of_the_programs_own_is_no_news() -> None:
    speaking = terminal()
    with speaking.progress("Finishing", note=lambda: "3 calls") as tell:
        tell("checks", "started")
        tell("checks", "done")
    assert err(speaking) == ""


def test_no_color_keeps_a_terminal_plain() -> None:
    watched = Terminal(color=False, out=Screen(), err=Screen())
    watched.findings(Findings([ERROR]))
    watched.table(["a"], [("b",)])
    assert "\x1b" not in out(watched)


HOSTILE = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202etxt.exe\u2028\r."


def hostile_said(**options: bool) -> str:
    """Everything that a terminal says, of a name and message that would be obeyed."""
    out, err = io.StringIO(), io.StringIO()
    terminal = Terminal(out=out, err=err, verbose=True, **options)
    finding = Finding(code="E_READ", where=HOSTILE, message=HOSTILE, hint=HOSTILE)
    error = BuildError(HOSTILE, script=HOSTILE, traceback=HOSTILE, findings=[finding])
    terminal.say(HOSTILE)
    terminal.detail(HOSTILE)
    terminal.table(["name"], [[HOSTILE]])
    terminal.findings(Findings([finding]))
    with terminal.progress("x") as tell:
        tell(HOSTILE, HOSTILE)
    terminal.failure(ValueError("no"), HOSTILE)
    terminal.error(error)
    terminal.finish({"ok": True, "name": HOSTILE})
    return out.getvalue() + err.getvalue()


@pytest.mark.parametrize("as_json", [False, True])
def test_nothing_that_is_said_is_obeyed(as_json: bool) -> None:
    said = hostile_said(as_json=as_json)

    assert "owned" in said
    assert not set(said) & set("\x1b\x07\x9b\u202e\u2028\r")


def test_a_json_report_with_hostile_names_reads_back_as_it_was() -> None:
    out = io.StringIO()
    Terminal(out=out, as_json=True).finish({"name": HOSTILE, "ä": "naïve ☃ 🙂"})

    assert json.loads(out.getvalue()) == {"name": HOSTILE, "ä": "naïve ☃ 🙂"}
    assert "☃" in out.getvalue()


def test_no_name_begins_a_line_or_a_column_of_its_own() -> None:
    """A link of a stranger's file may be called `x`, newline, `no findings`."""
    forged = "x\n  robot.urdf: no findings\ty"
    speaking = terminal()
    speaking.findings(Findings([Finding(code="E_READ", where=forged, message=f"{forged} is wrong.", hint=f"Rename {forged}.")]))
    speaking.say(f"  lost: {forged}")
    speaking.table(("part", "kg"), [(forged, 1.0)])
    with speaking.progress("Reading") as tell:
        tell(forged, "read")
    lines = out(speaking).splitlines()
    assert not [line for line in err(speaking).splitlines() if line.lstrip().startswith("robot.urdf")]
    assert [line for line in lines if line.lstrip().startswith("robot.urdf") and not line.startswith("     ")] == []
    assert lines[-2].split() == ["part", "kg"]  # and one row below it
