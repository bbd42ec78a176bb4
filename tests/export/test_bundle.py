from __future__ import annotations

import os
from pathlib import Path

import pytest

from articad.errors import ExportError
from articad.export.bundle import Bundle, Loss


def test_files_are_written_below_the_folder_and_replaced(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "a.urdf").write_text("old")
    (tmp_path / "out" / "mine.txt").write_text("mine")

    written = Bundle({"a.urdf": b"new", "meshes/b.stl": b"\0"}).write(tmp_path / "out")

    assert [path.relative_to(tmp_path).as_posix() for path in written] == ["out/a.urdf", "out/meshes/b.stl"]
    assert (tmp_path / "out" / "a.urdf").read_bytes() == b"new"
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.urdf", "meshes", "mine.txt"]


@pytest.mark.parametrize("path", ["../a", "/etc/a", "a/../../b", "", "a\\..\\b", "a\0b", "..", "link/a"])
def test_a_path_that_leads_outside_is_refused_and_nothing_is_written(path: str, tmp_path: Path) -> None:
    folder, outside = tmp_path / "out", tmp_path / "outside"
    folder.mkdir()
    outside.mkdir()
    (folder / "link").symlink_to(outside)

    with pytest.raises(ExportError) as error:
        Bundle({"good": b"1", path: b"2"}).write(folder)

    assert error.value.findings.codes == ("E_UNSAFE_PATH",)
    assert [entry.name for entry in folder.iterdir()] == ["link"]
    assert not list(outside.iterdir())


def test_a_file_that_cannot_be_put_in_place_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()

    with pytest.raises(OSError, match="a"):
        Bundle({"a": b"1"}).write(tmp_path)

    assert [entry.name for entry in tmp_path.iterdir()] == ["a"]


def test_files_have_the_permissions_that_the_user_asks_for(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        (path,) = Bundle({"a": b"1"}).write(tmp_path)
        assert path.stat().st_mode & 0o777 == 0o640
    finally:
        os.umask(before)


def test_the_report_lists_files_and_losses() -> None:
    bundle = Bundle({"a": b"123"}, (Loss("urdf", "joints.j", "this", "that"),))

    assert bundle.main == "a"
    assert bundle.to_json() == {
        "schema": "articad.losses/1",
        "ok": True,
        "files": {"a": 3},
        "rows": [{"format": "urdf", "where": "joints.j", "kept": "this", "lost": "that"}],
        "findings": [],
    }
    assert str(bundle.losses[0]) == "urdf joints.j: written as this; lost: that"
