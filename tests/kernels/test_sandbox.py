"""No attack gets through a level that scripts are run under; below that they are refused."""

from __future__ import annotations

import os
import re
import struct
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from articad.errors import BuildError, SandboxError
from articad.kernels import sandbox, seccomp
from articad.kernels.build123d import Build123dKernel
from tests.freecad import opened
from tests.kernels.attacks import ATTACKS, FREECAD_LEVELS, HIDDEN_BY_NAMESPACES, LEVELS, Range, kernel_at

ENOUGH = [layers for layers in (("bwrap", "landlock", "seccomp"), ("landlock", "seccomp")) if set(layers) <= sandbox.available()]


@pytest.fixture(scope="module", params=ENOUGH, ids="+".join)
def fortress(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Range, Build123dKernel]]:
    with Range(tmp_path_factory.mktemp("range")) as targets, kernel_at(request.param) as kernel:
        yield targets, kernel


@pytest.mark.parametrize("attack", ATTACKS)
def test_attack_is_stopped(fortress: tuple[Range, Build123dKernel], attack: str) -> None:
    targets, kernel = fortress
    through = targets.open_to(attack, kernel)

    assert bool(through) == (attack in HIDDEN_BY_NAMESPACES and "bwrap" not in kernel.level), through


def test_attacks_can_succeed(tmp_path: Path) -> None:
    """The suite itself is no sham: with nothing but limits, most of these get through."""
    with Range(tmp_path) as targets, kernel_at(()) as kernel:
        for attack in (
            "read a secret file",
            "write a file outside",
            "kill another process",
            "TCP connection",
            "fork",
            "remove a file outside",
        ):
            assert targets.open_to(attack, kernel) != "", attack


def test_levels_are_named_by_their_layers() -> None:
    assert sandbox.level_of({"seccomp", "landlock", "bwrap"}) == "bwrap+landlock+seccomp"
    assert sandbox.level_of({"seccomp", "landlock"}) == "landlock+seccomp"
    assert sandbox.level_of({"seccomp"}) == "weak"
    assert sandbox.level_of(()) == "weak"


def test_scripts_are_refused_without_landlock_or_bubblewrap(brief: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sandbox, "available", lambda: frozenset({"seccomp"}))
    monkeypatch.setattr(sandbox, "missing", lambda: ("bubblewrap: not installed", "Landlock: this kernel does not offer it"))
    kernel = Build123dKernel()

    with pytest.raises(SandboxError, match=r"bubblewrap: not installed; Landlock.*apt-get install bubblewrap.*--sandbox weak") as caught:
        kernel.build(b"", brief)

    assert caught.value.findings.codes == ("E_SANDBOX",)
    assert kernel.pid is None  # nothing was started


def test_other_systems_are_refused_even_when_weak(brief: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    monkeypatch.setattr(sandbox, "available", sandbox.available.__wrapped__)

    with pytest.raises(SandboxError, match="on Linux only, not on darwin: use a Linux container or WSL 2"):
        Build123dKernel(sandbox="weak").build(b"", brief)


def test_weak_runs_scripts_and_says_so(brief: dict[str, Any]) -> None:
    kernel = Build123dKernel(sandbox="weak", layers=())
    try:
        built = kernel.build(b"from build123d import Box\ndef build(part):\n    return Box(1, 1, 1), {}\n", brief)
    finally:
        kernel.close()

    assert built.sandbox == "weak"


def test_level_is_recorded(kernel: Build123dKernel, brief: dict[str, Any]) -> None:
    built = kernel.build(b"from build123d import Box\ndef build(part):\n    return Box(1, 1, 1), {}\n", brief)

    assert built.sandbox == sandbox.level()


def test_environment_chooses_the_sandbox(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARTICAD_SANDBOX", "weak")
    assert Build123dKernel().mode == "weak"
    assert Build123dKernel(sandbox="strict").mode == "strict"

    monkeypatch.setenv("ARTICAD_SANDBOX", "lax")
    with pytest.raises(SandboxError, match="strict and weak"):
        Build123dKernel()


def test_without_user_namespaces_landlock_still_holds() -> None:
    """In a user namespace that may make no others, as in many containers, bubblewrap fails its trial and is left out."""
    code = "from articad.kernels import sandbox; print(sandbox.level(), '|', *sandbox.missing())"
    inside = f"echo 0 > /proc/sys/user/max_user_namespaces && exec {sys.executable} -c {code!r}"
    tried = subprocess.run(["unshare", "--user", "--map-root-user", "sh", "-c", inside], capture_output=True, text=True, check=False)
    if tried.returncode != 0:
        pytest.skip(f"no user namespaces here at all: {tried.stderr[:100]}")

    level = tried.stdout.partition("|")[0].strip()
    assert "bwrap" not in level
    assert level == sandbox.level_of(sandbox.available() - {"bwrap"})


HEADERS = {"x86_64": "/usr/include/x86_64-linux-gnu/asm/unistd_64.h", "aarch64": "/usr/include/asm-generic/unistd.h"}


@pytest.mark.parametrize("machine", HEADERS)
def test_system_call_numbers_are_those_of_the_kernels_headers(machine: str) -> None:
    header = Path(HEADERS[machine])
    if not header.exists():
        pytest.skip("linux-libc-dev is not installed")
    defined = {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+)\s+(\d+)", header.read_text())}
    defined.setdefault("newfstatat", defined.get("fstatat", -1))

    for name, number in seccomp._ARCHITECTURES[machine].calls.items():
        assert defined[name] == number, name


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_every_jump_of_the_filter_lands_inside_it(machine: str) -> None:
    code = seccomp.program(machine, 42)
    lines = [code[at : at + 8] for at in range(0, len(code), 8)]

    assert len(lines) < 4096  # the kernel's bound
    for at, line in enumerate(lines):
        operation, if_true, if_false = int.from_bytes(line[:2], "little"), line[2], line[3]
        if operation & 0x07 == 0x05:
            assert at + 1 + max(if_true, if_false) < len(lines)
    assert int.from_bytes(lines[-1][:2], "little") == 0x06  # it ends in a return


EPERM, EAGAIN, EACCES, ENOSYS, ALLOW, KILL = 1, 11, 13, 38, "allow", "kill"
PID = 4242
ARGUMENTS: list[tuple[str, tuple[int, ...], object]] = [
    ("read", (0,), ALLOW),
    ("openat", (0, 0, os.O_RDONLY | os.O_CLOEXEC), ALLOW),
    ("openat", (0, 0, os.O_WRONLY), EACCES),
    ("openat", (0, 0, os.O_RDWR), EACCES),
    ("openat", (0, 0, os.O_RDONLY | os.O_CREAT), EACCES),
    ("openat", (0, 0, os.O_RDONLY | os.O_TRUNC), EACCES),
    ("openat2", (), ENOSYS),
    ("clone3", (), ENOSYS),
    ("clone", (0x3D0F00,), EAGAIN),  # what pthread_create asks for
    ("clone", (0x1200011,), EAGAIN),  # what fork asks for
    ("clone", (0x10000000,), EAGAIN),  # a user namespace
    ("tgkill", (PID, 1, 6), ALLOW),
    ("tgkill", (PID + 1, 1, 9), EPERM),
    ("fcntl", (3, 1), ALLOW),
    ("fcntl", (3, 8, 1), EPERM),  # F_SETOWN
    ("ioctl", (0, 0x5401), ALLOW),
    ("ioctl", (0, 0x5412), EPERM),  # TIOCSTI
    ("prctl", (15,), ALLOW),
    ("prctl", (4, 1), EPERM),  # PR_SET_DUMPABLE
    ("prlimit64", (0, 7, 0, 1), ALLOW),
    ("prlimit64", (0, 7, 1, 0), EPERM),
    ("prlimit64", (0, 7, 1 << 40, 0), EPERM),
]
UNLISTED = {
    "x86_64": {
        "socket": 41,
        "execve": 59,
        "kill": 62,
        "ptrace": 101,
        "mount": 165,
        "fork": 57,
        "io_uring_setup": 425,
        "memfd_create": 319,
    },
    "aarch64": {
        "socket": 198,
        "execve": 221,
        "kill": 129,
        "ptrace": 117,
        "mount": 40,
        "io_uring_setup": 425,
        "memfd_create": 279,
    },
}


def judged(machine: str, number: int, arguments: tuple[int, ...], token: int | None = None) -> object:
    """Run the filter as the kernel does: classic BPF over struct seccomp_data."""
    known = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
    words = struct.pack("<IIQ6Q", number, known[machine] if token is None else token, 0, *arguments, *[0] * (6 - len(arguments)))
    lines = list(struct.iter_unpack("<HBBI", seccomp.program(machine, PID)))
    at, accumulator = 0, 0
    while True:
        operation, if_true, if_false, value = lines[at]
        at += 1
        if operation == 0x20:
            accumulator = struct.unpack_from("<I", words, value)[0]
        elif operation == 0x06:
            return {0x7FFF0000: ALLOW, 0x80000000: KILL}.get(value, value & 0xFFFF)
        else:
            holds = {0x15: accumulator == value, 0x35: accumulator >= value, 0x45: bool(accumulator & value)}[operation]
            at += if_true if holds else if_false


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_the_filter_decides_by_call_and_argument(machine: str) -> None:
    numbers = seccomp._ARCHITECTURES[machine].calls

    for name, arguments, verdict in ARGUMENTS:
        assert judged(machine, numbers[name], arguments) == verdict, (name, arguments)
    for name, number in UNLISTED[machine].items():
        assert judged(machine, number, ()) == EPERM, name
    assert judged(machine, 0, (), token=0x40000003) == KILL  # 32-bit x86


def test_the_second_abi_of_x86_64_is_closed() -> None:
    assert judged("x86_64", 0x40000000, ()) == KILL
    assert judged("x86_64", 2, (0, os.O_WRONLY)) == EACCES  # the old open
    assert judged("x86_64", 2, (0, os.O_RDONLY)) == ALLOW


@pytest.mark.freecad
@opened.needs_freecad
def test_no_attack_gets_out_of_freecad(tmp_path: Path) -> None:
    layers = ("bwrap", "landlock", "seccomp")
    if not set(layers) <= sandbox.available():
        pytest.skip(f"this machine reaches {sandbox.level()}")
    with Range(tmp_path) as targets, kernel_at(layers, "freecad") as kernel:
        through = {attack: how for attack, how in targets.all_open_to(kernel).items() if how}

    assert kernel.level == "bwrap+landlock+seccomp"
    assert through == {}


def test_a_sandbox_that_cannot_be_put_on_is_said_by_nobody_but_the_worker(brief: dict[str, Any], kernel: Build123dKernel) -> None:
    """A script that writes what a worker would say, and ends as it would, is a script that ended."""
    script = (
        b"import os\n"
        b"def build(part):\n"
        b"    for number in range(3, 64):\n"
        b"        try:\n"
        b"            os.write(number, b'worker: OSError: landlock: broken\\n')\n"
        b"        except OSError:\n"
        b"            pass\n"
        b"    os._exit(70)\n"
    )
    with pytest.raises(BuildError) as lied:
        kernel.build(script, brief)
    assert "E_SANDBOX" not in lied.value.findings.codes

    broken = Build123dKernel()
    broken.limits = replace(broken.limits, file_size="many")  # type: ignore[arg-type]
    with pytest.raises(SandboxError, match="could not be set up: worker: TypeError") as true:
        broken.build(b"def build(part):\n    return None\n", brief)
    assert true.value.findings.codes == ("E_SANDBOX",)


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.skipif("bwrap" not in sandbox.available(), reason="FreeCAD is confined by bubblewrap")
def test_without_landlock_freecad_has_no_proc_to_climb_out_by(tmp_path: Path) -> None:
    """As root the kernel could be set there; as anybody, bubblewrap's own process be written to, which seccomp does not bind."""
    ways = ("change kernel settings", "read the worker's memory", "reopen result files by their numbers", "read kernel settings")
    with Range(tmp_path) as targets, kernel_at(("bwrap", "seccomp"), "freecad") as kernel:
        assert {way: targets.open_to(way, kernel) for way in ways} == dict.fromkeys(ways, "")


@pytest.mark.parametrize(("kernel", "levels"), [("build123d", LEVELS), ("freecad", FREECAD_LEVELS)])
def test_the_documentation_has_every_attack_at_every_level_and_nothing_open_by_default(
    kernel: str, levels: Sequence[tuple[str, ...]]
) -> None:
    text = (Path(__file__).parents[2] / "docs/reference/sandbox.md").read_text()
    table = text[text.index(f"Kernel {kernel}") :].partition("\n\n")[2].partition("\n\n")[0].splitlines()
    rows = {cells[1].strip(): [cell.strip() for cell in cells[2:-1]] for cells in (line.split("|") for line in table)}

    assert rows.pop("attack") == ["+".join(layers) or "limits only" for layers in levels]
    assert rows.pop("---")
    assert set(rows) == set(ATTACKS)
    assert {row[-1] for row in rows.values()} == {"blocked"}
