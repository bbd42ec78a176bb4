"""First names of files for names that anybody may have given."""

from __future__ import annotations

import itertools

import pytest

from articad.export.names import file_name

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


@pytest.mark.parametrize("name", ["gripper", "console", "arm_v1.2", "com10", "auxiliary"])
def test_ordinary_names_stay(name: str) -> None:
    assert file_name(name) == name
