"""The error of a failing script names its line and the cause, shows no path of this machine, and returns the solids it had."""

from __future__ import annotations

import copy
import time
from typing import Any

import pytest

from articad.errors import BuildError
from articad.kernels.build123d import Build123dKernel
from articad.kernels.results import read_mesh
from articad.kernels.sandbox import ScriptLimits
from tests.kernels.conftest import HEAD, Build, kernel_of_its_own

FIRST = len(HEAD.splitlines()) + 1  # line of the body's first line


@pytest.fixture
def hasty(kernel: Build123dKernel) -> Build123dKernel:
    """The same zygote under narrower limits."""
    kernel.warm_up()
    other = copy.copy(kernel)
    other.limits = ScriptLimits(seconds=1.0, probe_seconds=0.5, memory=2**31)
    return other


def failure(build: Build, body: str, **changes: Any) -> BuildError:
    with pytest.raises(BuildError) as caught:
        build(body, **changes)
    assert len(caught.value.findings) == 1
    return caught.value


def test_an_exception_is_told_with_its_line_and_the_scripts_frames(build: Build) -> None:
    error = failure(build, "def inner(x):\n    return Box(x, 1, 1) / 0\ninner(3)\nreturn Box(1, 1, 1), {}")

    assert error.findings.codes == ("E_SCRIPT_ERROR",)
    assert error.line == FIRST + 1
    assert error.traceback.splitlines() == [
        f"line {FIRST + 2}, in build: inner(3)",
        f"line {FIRST + 1}, in inner: return Box(x, 1, 1) / 0",
    ]
    assert "TypeError" in str(error)


def test_a_syntax_error_has_its_line(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    with pytest.raises(BuildError) as caught:
        kernel.build(b"x = 1\ndef build(part:\n    pass\n", brief)

    assert caught.value.findings.codes == ("E_SCRIPT_ERROR",)
    assert caught.value.line == 2


def test_no_path_or_address_of_this_machine_is_told(build: Build) -> None:
    error = failure(build, "import os\nraise RuntimeError(f'{os} {object()} ' + '/'.join(['', 'home', 'someone', 'id_rsa']))")

    assert "/home" not in str(error)
    assert "0x" not in str(error)
    assert "lib/python" not in str(error)
    assert "id_rsa" in str(error)


def test_control_characters_of_a_message_do_not_reach_a_terminal(build: Build) -> None:
    assert "\x1b" not in str(failure(build, "raise RuntimeError(chr(27) + '[31mred' + 'x' * 100000)"))


def test_control_characters_of_a_script_reach_no_terminal_and_count_no_lines(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    script = 'def build(part):\n    x = "\x0c\u2028\x85\x1b]0;here\x07\u202e\x9b2J"; raise ValueError(x)\n'
    with pytest.raises(BuildError) as caught:
        kernel.build(script.encode(), brief)

    assert str(caught.value).isprintable()
    assert caught.value.traceback.isprintable()
    assert "raise ValueError(x)" in caught.value.traceback


@pytest.mark.parametrize("body", ["import sys\nsys.exit(3)", "import os\nos._exit(0)", "raise KeyboardInterrupt"])
def test_ending_the_process_is_an_error_of_the_script(build: Build, body: str) -> None:
    assert failure(build, body).findings.codes == ("E_SCRIPT_ERROR",)


def test_a_crash_of_the_kernel_is_told_with_its_line(build: Build) -> None:
    error = failure(build, "import ctypes\nctypes.string_at(0)")

    assert error.findings.codes == ("E_SCRIPT_ERROR",)
    assert error.line == FIRST + 1
    assert "SIGSEGV" in str(error)


@pytest.mark.parametrize("body", ["while True:\n    pass", "import time\ntime.sleep(99)", "for _ in range(10**9):\n    Box(1, 1, 1)"])
def test_a_script_that_does_not_end_is_stopped_and_told_where_it_was(build: Build, hasty: Build123dKernel, body: str) -> None:
    error = failure(build, body, with_kernel=hasty)

    assert error.findings.codes == ("E_SCRIPT_TIMEOUT",)
    assert error.findings[0].limit == 1.0
    assert error.line in (FIRST, FIRST + 1)


def test_a_script_that_a_busy_machine_makes_slow_is_not_stopped(build: Build, hasty: Build123dKernel) -> None:
    """It may take a second of processor time; it takes three on the clock."""
    assert build("import time\ntime.sleep(3)\nreturn Box(1, 1, 1), {}", with_kernel=hasty) is not None


DEFIANT = """import signal
for timer in (signal.ITIMER_REAL, signal.ITIMER_PROF):
    signal.setitimer(timer, 0)
for number in (signal.SIGALRM, signal.SIGPROF, signal.SIGXCPU):
    signal.signal(number, signal.SIG_IGN)
while True:
    pass"""


def test_a_script_that_defies_the_alarm_is_stopped_all_the_same(build: Build, hasty: Build123dKernel) -> None:
    assert failure(build, DEFIANT, with_kernel=hasty).findings.codes == ("E_SCRIPT_TIMEOUT",)


def test_a_script_that_defies_the_alarm_does_not_get_the_time_of_the_probe(build: Build) -> None:
    kernel = kernel_of_its_own(timeout=1.0, probe_timeout=90.0)
    kernel.warm_up()
    started = time.monotonic()
    try:
        error = failure(build, DEFIANT, with_kernel=kernel, probe=True)
    finally:
        kernel.close()
    assert (error.findings.codes, error.findings[0].limit) == (("E_SCRIPT_TIMEOUT",), 1.0)
    assert time.monotonic() - started < 60.0  # it was 93 s


@pytest.mark.parametrize("body", ["x = bytearray(3 << 30)", "x = 'x' * (1 << 40)", "x = [bytes(1 << 28) for _ in range(99)]"])
def test_too_much_memory_is_told(build: Build, hasty: Build123dKernel, body: str) -> None:
    assert failure(build, body, with_kernel=hasty).findings.codes == ("E_SCRIPT_MEMORY",)


@pytest.mark.parametrize(
    "body",
    [
        "open('/etc/passwd').read()",
        "open('out.txt', 'w')",
        "export_step(Box(1, 1, 1), '/tmp/out.step')",
        "import articad",
        "from articad.kernels import sandbox",
        "import socket\nsocket.socket()",
        "import subprocess\nsubprocess.run(['/bin/true'])",
    ],
)
def test_what_a_script_may_not_do_is_told_as_such(build: Build, body: str) -> None:
    error = failure(build, body)

    assert error.findings.codes == ("E_SCRIPT_FORBIDDEN",)
    assert "may only compute a shape" in error.findings[0].hint


def test_a_failed_script_hands_back_the_solids_it_held(build: Build) -> None:
    error = failure(build, "body = Box(10, 10, 10)\nbody -= Cylinder(2, 20)\npin = Pos(30, 0, 0) * Box(1, 2, 3)\nraise ValueError('stuck')")

    assert error.partial is not None
    mesh = read_mesh((error.partial / "part.npz").read_bytes())
    assert mesh.volume == pytest.approx(1000 - 3.14159 * 40 + 6, rel=1e-3)


def test_a_script_that_fails_before_it_has_a_solid_hands_back_nothing(build: Build) -> None:
    assert failure(build, "raise ValueError").partial is None


def test_the_script_sees_the_object_that_the_contract_names(build: Build) -> None:
    joints: list[dict[str, Any]] = [
        {
            "name": "hinge",
            "type": "revolute",
            "side": "child",
            "mate": "aligned",
            "limits": {"angle_deg": "endless"},
            "fit": None,
            "other": "base.a",
        }
    ]
    connectors = {"a": {"o": [1, 2, 3], "z": [0, 0, 1], "x": [1, 0, 0], "label": "pin", "joints": joints}}
    body = (
        "c = part.connectors['a']\n"
        "assert (part.name, part.description, part.material) == ('lug', 'A lug.', 'steel')\n"
        "assert (c.o, c.z, c.x, c.label) == ((1, 2, 3), (0, 0, 1), (1, 0, 0), 'pin')\n"
        "assert c.joints[0]['side'] == 'child' and c.joints[0]['type'] == 'revolute'\n"
        "assert d == {'w': 4.0, 'n_count': 3} and isinstance(d['n_count'], int)\n"
        "return Box(d['w'], 1, 1), {'a': {'o': c.o, 'z': c.z, 'x': c.x}}"
    )

    assert build(body, connectors=connectors, dimensions={"w": 4.0, "n_count": 3}).solid.volume == pytest.approx(4)


def test_printing_is_ignored_however_much(build: Build) -> None:
    body = "import sys, os\nfor _ in range(300):\n    print('x' * 100000)\n    os.write(2, b'y' * 100000)\nreturn Box(1, 1, 1), {}"

    assert build(body).solid.volume == pytest.approx(1)
