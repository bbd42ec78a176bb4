"""Cases are kept, found by likeness, and survive killed writers, torn files and later versions."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from articad.errors import ReadError, WriteError
from articad.memory.case import Case, PartExample
from articad.memory.embedding import FloatArray, WordLlamaEmbedder, normalised
from articad.memory.experience import FILE, VERSION, ExperienceStore

DOOR = PartExample("door", "A flat panel that turns about a bore along its left edge.", "build123d", "def build(part): ...")
GEAR = PartExample("gear", "A spur gear of twenty teeth round a shaft.", "build123d", "def build(part): ...")
WARDROBE = Case(kind="good", prompt="A wardrobe with double doors above two drawers.", parts=(DOOR,))
CLOCK = Case(kind="good", prompt="A clock whose hands are driven by gears.", parts=(GEAR,))
BAD_CUPBOARD = Case(kind="issue", prompt="A cupboard with doors.", defects=("E_OVERLAP door, cabinet: 3 mm",), parts=(DOOR,))


class Letters:
    """Counts letters: a space of its own, in which everything can be said beforehand."""

    name = "letters"

    def __init__(self) -> None:
        self.embedded: list[str] = []

    def embed(self, texts: Sequence[str]) -> FloatArray:
        self.embedded += texts
        return normalised([[text.count(letter) for letter in "abcdefghijklmnopqrstuvwxyz"] for text in texts] or np.zeros((0, 26)))


@pytest.fixture
def store(tmp_path: Path) -> ExperienceStore:
    return ExperienceStore(tmp_path, Letters())


def test_a_store_that_was_never_written_is_empty_and_leaves_no_file(tmp_path: Path) -> None:
    store = ExperienceStore(tmp_path / "none")
    assert len(store) == 0
    assert store.cases() == ()
    assert store.like_request("a wardrobe", "good") == ()
    assert not (tmp_path / "none").exists()


def test_a_request_finds_what_means_the_same_in_other_words(tmp_path: Path) -> None:
    store = ExperienceStore(tmp_path, WordLlamaEmbedder())
    store.add(WARDROBE, CLOCK, BAD_CUPBOARD)
    first, second = store.like_request("A closet, two hinged doors, drawers at the bottom", "good")
    assert first.case == WARDROBE
    assert first.likeness > 0.4
    assert second.likeness < 0.2
    (found,) = store.like_part("panel with a hinge at its edge", "build123d", limit=1)
    assert (found.case, found.item) == (WARDROBE, "door")


def test_issues_and_good_cases_are_never_mixed(store: ExperienceStore) -> None:
    store.add(WARDROBE, CLOCK, BAD_CUPBOARD)
    assert {hit.case for hit in store.like_request("doors", "good", limit=9)} == {WARDROBE, CLOCK}
    assert [hit.case for hit in store.like_request("doors", "issue", limit=9)] == [BAD_CUPBOARD]
    assert {hit.case.kind for hit in store.like_part(DOOR.specification, "build123d", limit=9)} == {"good"}
    assert store.like_part(DOOR.specification, "freecad") == ()


def test_the_same_case_is_kept_once_and_its_texts_are_embedded_once(store: ExperienceStore) -> None:
    assert store.add(WARDROBE, CLOCK) == 2
    assert store.add(WARDROBE) == 0
    assert store.like_request("doors", "good") == store.like_request("doors", "good")
    assert isinstance(store.embedder, Letters)
    assert store.embedder.embedded.count(WARDROBE.request) == 1


def test_two_spaces_are_never_compared(store: ExperienceStore) -> None:
    store.add(WARDROBE, CLOCK)
    before = store.like_request("wardrobe", "good")
    other = ExperienceStore(store.folder, WordLlamaEmbedder())
    assert other.like_request("wardrobe", "good")[0].likeness != before[0].likeness
    assert store.like_request("wardrobe", "good") == before


def test_faiss_finds_what_the_exact_search_finds_and_is_rebuilt_when_torn_or_old(store: ExperienceStore) -> None:
    fast = ExperienceStore(store.folder, store.embedder, index="faiss")
    assert fast.like_request("doors", "good") == ()
    store.add(WARDROBE, CLOCK)
    for _ in range(2):
        hits = fast.like_request("doors", "good")
        assert [hit.case for hit in hits] == [hit.case for hit in store.like_request("doors", "good")]
    (file,) = store.folder.glob("*.faiss")
    file.write_bytes(file.read_bytes()[:-7])
    assert [hit.case for hit in fast.like_request("doors", "good")] == [hit.case for hit in hits]
    store.add(Case(kind="good", prompt="doors"))
    assert fast.like_request("doors", "good")[0].case.prompt == "doors"


def test_the_oldest_of_each_kind_are_pruned(store: ExperienceStore) -> None:
    for case in (WARDROBE, BAD_CUPBOARD, CLOCK):
        store.add(case)
    assert store.prune(1) == 1
    assert set(store.cases()) == {BAD_CUPBOARD, CLOCK}
    assert store.remove(CLOCK.id, "none") == 1
    assert store.like_part(GEAR.specification, "build123d") == ()


def test_what_is_exported_can_be_imported_and_a_bad_line_adds_nothing(store: ExperienceStore, tmp_path: Path) -> None:
    store.add(WARDROBE, BAD_CUPBOARD)
    lines = list(store.export())
    other = ExperienceStore(tmp_path / "other", Letters())
    with pytest.raises(ReadError, match="Line 2"):
        other.import_lines([lines[0], '{"schema": "articad.case/1", "kind": "ugly"}'])
    assert len(other) == 0
    assert other.import_lines(lines) == 2
    assert other.cases() == store.cases()
    assert other.case(WARDROBE.id[:6]) == WARDROBE
    with pytest.raises(ReadError, match="begin with"):
        other.case("zz")


def test_a_torn_file_is_named_and_left_alone(store: ExperienceStore) -> None:
    store.add(WARDROBE)
    file = store.folder / FILE
    for leftover in store.folder.glob(f"{FILE}-*"):
        leftover.unlink()
    torn = file.read_bytes()[:3000]
    file.write_bytes(torn)
    with pytest.raises(ReadError, match="import an export"):
        store.cases()
    with pytest.raises(WriteError, match=FILE):
        store.add(CLOCK)
    assert file.read_bytes()[100:] == torn[100:]


def test_a_later_version_s_store_is_refused_unchanged(store: ExperienceStore) -> None:
    store.add(WARDROBE)
    with sqlite3.connect(store.folder / FILE) as database:
        database.execute(f"pragma user_version = {VERSION + 1}")
    with pytest.raises(ReadError, match="later version"):
        store.add(CLOCK)


WRITER = """
import sys
from articad.memory.case import Case
from articad.memory.experience import ExperienceStore
store = ExperienceStore(sys.argv[1])
for number in range(int(sys.argv[3])):
    store.add(Case(kind="good", prompt=f"{sys.argv[2]} {number}"))
    print(number, flush=True)
"""


def writer(folder: Path, name: str, count: int) -> subprocess.Popen[str]:
    return subprocess.Popen([sys.executable, "-c", WRITER, str(folder), name, str(count)], stdout=subprocess.PIPE, text=True)


def test_four_writers_at_once_lose_nothing(tmp_path: Path) -> None:
    writers = [writer(tmp_path, name, 25) for name in "abcd"]
    assert [process.wait(timeout=120) for process in writers] == [0, 0, 0, 0]
    assert sorted(case.prompt for case in ExperienceStore(tmp_path).cases()) == sorted(f"{name} {k}" for name in "abcd" for k in range(25))


def test_what_was_committed_survives_kill_9(tmp_path: Path) -> None:
    told: set[str] = set()
    for attempt in range(6):
        process = writer(tmp_path, f"w{attempt}", 100_000)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(0.02 * attempt)
        os.kill(process.pid, signal.SIGKILL)
        last = process.stdout.read().splitlines()
        process.wait()
        told |= {f"w{attempt} {k}" for k in range(int(last[-1]) + 1 if last else 1)}
        kept = {case.prompt for case in ExperienceStore(tmp_path).cases()}
        assert told <= kept
        assert len(kept - told) <= attempt + 1  # at most one case of each writer that was committed but not yet reported
    assert json.loads(next(iter(ExperienceStore(tmp_path).export())))["schema"] == "articad.case/1"


GOOD = Case(kind="good", prompt="a box", scores={"a": 1.0}).to_json()


@pytest.mark.parametrize(
    "line",
    [
        json.dumps(GOOD | {"prompt": 3}),
        json.dumps(GOOD | {"design": {"a": 1}}),
        json.dumps(GOOD | {"scores": {"a": "much"}}),
        json.dumps(GOOD | {"scores": {"a": 10**400}}),
        json.dumps(GOOD | {"scores": {"a": float("nan")}}),
        json.dumps(GOOD | {"parts": [{"name": ["a"], "specification": "", "kernel": "build123d", "script": ""}]}),
        "3",
        "[" * 100_000,
        "",
    ],
    ids=range(9),
)
def test_a_strangers_line_that_is_no_case_adds_nothing(tmp_path: Path, line: str) -> None:
    store = ExperienceStore(tmp_path / "memory")
    with pytest.raises(ReadError):
        store.import_lines([json.dumps(GOOD), line])
    assert len(store) == 0


def test_vectors_of_another_size_are_computed_again(store: ExperienceStore) -> None:
    store.add(WARDROBE, CLOCK)
    before = store.like_request("doors", "good")
    embedder = store.embedder

    class Shorter:
        """Another model of the same name."""

        name = embedder.name

        def embed(self, texts: Sequence[str]) -> FloatArray:
            return embedder.embed(texts)[:, :7]

    store.embedder = Shorter()
    assert {hit.case for hit in store.like_request("doors", "good")} == {hit.case for hit in before}
