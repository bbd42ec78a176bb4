"""The cache: whole folders or none, checked when used, shared by processes."""

from __future__ import annotations

import errno
import multiprocessing
import os
import time
from pathlib import Path

import pytest

from articad.errors import KernelError
from articad.kernels.cache import BuildCache, default_root


def filled(cache: BuildCache, digest: str, text: str = "x") -> Path:
    with cache.writing(digest) as folder:
        (folder / "a").write_text(text)
        (folder / "b").write_text(text * 1000)
    return cache.root / digest


def test_what_was_written_is_found(tmp_path: Path) -> None:
    cache = BuildCache(tmp_path)

    folder = filled(cache, "d1")

    assert cache.get("d1") == folder
    assert (folder / "a").read_text() == "x"
    assert cache.get("d2") is None


def test_an_error_leaves_nothing(tmp_path: Path) -> None:
    cache = BuildCache(tmp_path)

    def stop_half_way() -> None:
        with cache.writing("d") as folder:
            (folder / "a").write_text("half")
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        stop_half_way()

    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("harm", ["change", "truncate", "remove", "seal", "no seal"])
def test_a_spoiled_folder_is_no_hit_and_is_replaced(tmp_path: Path, harm: str) -> None:
    cache = BuildCache(tmp_path)
    folder = filled(cache, "d")
    if harm == "change":
        (folder / "b").write_text("y" * 1000)
    elif harm == "truncate":
        os.truncate(folder / "b", 10)
    elif harm == "remove":
        (folder / "a").unlink()
    elif harm == "seal":
        (folder / "seal.json").write_text("[")
    else:
        (folder / "seal.json").unlink()

    assert cache.get("d") is None

    filled(cache, "d", "z")
    found = cache.get("d")
    assert found is not None
    assert (found / "a").read_text() == "z"


def test_the_first_writer_wins(tmp_path: Path) -> None:
    cache = BuildCache(tmp_path)
    with cache.writing("d") as slow:
        (slow / "a").write_text("slow")
        filled(cache, "d", "fast")

    assert (tmp_path / "d" / "a").read_text() == "fast"
    assert [path.name for path in tmp_path.iterdir()] == ["d"]


def test_a_spoiled_folder_in_the_way_is_replaced(tmp_path: Path) -> None:
    cache = BuildCache(tmp_path)
    with cache.writing("d") as folder:
        (folder / "a").write_text("new")
        filled(cache, "d", "old")
        (tmp_path / "d" / "a").write_text("spoiled")

    assert (tmp_path / "d" / "a").read_text() == "new"


def _write(root: Path, number: int) -> bool:
    cache = BuildCache(root)
    for turn in range(20):
        filled(cache, f"d{turn}", str(turn))
        found = cache.get(f"d{turn}")
        if found is None or (found / "a").read_text() != str(turn):
            return False
    return number >= 0


def test_several_processes_write_the_same_digests(tmp_path: Path) -> None:
    with multiprocessing.get_context("spawn").Pool(3) as pool:
        good = pool.starmap(_write, [(tmp_path, number) for number in range(3)])

    assert all(good)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(f"d{turn}" for turn in range(20))


def test_folders_that_a_dead_process_left_are_swept_after_a_day(tmp_path: Path) -> None:
    cache = BuildCache(tmp_path)
    for name, age in ((".building-old", 90000), (".building-new", 60)):
        (tmp_path / name).mkdir()
        os.utime(tmp_path / name, (time.time() - age,) * 2)

    filled(cache, "d")

    assert sorted(path.name for path in tmp_path.iterdir()) == [".building-new", "d"]


def test_the_root_is_the_users_unless_it_is_given(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path))
    assert default_root() == tmp_path
    assert BuildCache().root == tmp_path

    monkeypatch.delenv("ARTICAD_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert BuildCache().root == tmp_path / "cache" / "articad" / "parts"


def test_no_root_is_a_cache_that_goes_with_its_object() -> None:
    cache = BuildCache(None)
    root = cache.root
    filled(cache, "d")
    assert cache.get("d") is not None

    del cache

    assert not root.exists()


def test_a_folder_that_cannot_be_written_is_an_error_with_a_way_out(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")

    with pytest.raises(KernelError, match="Set ARTICAD_CACHE"):
        filled(BuildCache(tmp_path / "file" / "cache"), "d")


def test_a_full_disk_is_an_error_and_leaves_nothing(tmp_path: Path) -> None:
    def write_until_full() -> None:
        with BuildCache(tmp_path).writing("d"):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(KernelError, match="No space left on device"):
        write_until_full()

    assert list(tmp_path.iterdir()) == []
