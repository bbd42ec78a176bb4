"""First names of files for names that anybody may have given."""

from __future__ import annotations

import itertools
import random
import string

import pytest

from articad.export.names import file_name, file_names

_DEVICES = ("con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10)))  # Microsoft's list


@pytest.mark.parametrize("device", _DEVICES)
def test_no_file_is_called_like_a_device_of_windows(device: str) -> None:
    for name, suffix in itertools.product((device, device.upper(), f" {device}", f"../{device}"), ("", ".stl", ".a.b")):
        assert file_name(name + suffix).partition(".")[0].lower() not in _DEVICES


@pytest.mark.parametrize("before", range(55, 64))
def test_no_file_name_that_was_cut_ends_in_a_dot(before: int) -> None:
    name = file_name("x" * before + "." * 3 + "y" * 9)
    assert len(name) <= 60
    assert not name.endswith(".")


@pytest.mark.parametrize("name", ["aux.", "con." + "x" * 56, "lpt1." + "y" * 80, "nul" + "." * 90], ids=len)
def test_the_name_of_a_device_is_no_longer_than_others(name: str) -> None:
    assert len(file_name(name)) <= 60
    assert file_name(name).partition(".")[0].lower() not in _DEVICES


@pytest.mark.parametrize("name", ["-rf", "--help", "_-x", ".-y"])
def test_no_file_is_called_like_an_option(name: str) -> None:
    assert file_name(name)[0] in string.ascii_letters


def test_no_two_names_share_a_file_and_names_that_are_valid_keep_theirs() -> None:
    """Names that differ in what a file name cannot hold, in case, or after the 60th character; case alone is one file on Windows and macOS."""
    wanted = [
        "a b",
        "a_b",
        "C_d",
        "c_d",
        "a/b",
        "a_b_2",
        "",
        ".",
        "x" * 70,
        "x" * 71,
        "con",
        "CON",
        "con_file",
        "\u00e4",
        "\u00f6",
        "assembly",
    ]
    for seed in range(20):
        order = random.Random(seed).sample(wanted, len(wanted))
        files = file_names(order, ["assembly"])
        assert set(files) == set(wanted)
        assert len({file.casefold() for file in files.values()} | {"assembly"}) == len(wanted) + 1
        assert files["a_b_2"] == "a_b_2"
        assert not {file.partition(".")[0].lower() for file in files.values()} & set(_DEVICES)


@pytest.mark.parametrize("name", ["gripper", "console", "arm_v1.2", "com10", "auxiliary"])
def test_ordinary_names_stay(name: str) -> None:
    assert file_name(name) == name
