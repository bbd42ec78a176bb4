"""The run directory: whole files only, one writer, nothing lost, no times outside the trace."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from articad.errors import ArticadError, ReadError, RunError, WriteError
from articad.runs.run import Run, RunRequest, UserImage, canonical_json, differences, digest, open_or_create, write_atomically

PNG = b"\x89PNG\r\n\x1a\n" + bytes(16)


def request(prompt: str = "a lamp", **options: object) -> RunRequest:
    return RunRequest(prompt=prompt, options=options)


def test_the_default_name_has_date_words_and_four_hex_digits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with Run.create(request("Generate a Wardrobe, größer als 2 m: with " + "very " * 30 + "long text")) as run:
        assert re.fullmatch(r"\d{4}-\d\d-\d\d-generate-a-wardrobe-groer-als-2-m-with-v-[0-9a-f]{4}", run.path.name)
    with Run.create(request("机器人")) as run:
        assert re.fullmatch(r"\d{4}-\d\d-\d\d-run-[0-9a-f]{4}", run.path.name)


def test_a_request_comes_back_as_it_was_given(tmp_path: Path) -> None:
    images = (UserImage.read(PNG), UserImage.read(b"\xff\xd8\xff rest", part="door"))
    asked = RunRequest(prompt="zwei Türen", images=images, options={"repairs": 3})
    with Run.create(asked, out=tmp_path / "r"):
        pass
    seen = Run.view(tmp_path / "r")

    assert seen.request.same_as(asked)
    assert seen.prompt == "zwei Türen"
    assert seen.request.images == images
    assert seen.version
    assert json.loads((tmp_path / "r/request.json").read_text())["images"][1]["part"] == "door"


@pytest.mark.parametrize("content", [b"", b"GIF", b"%PDF-1.4", b"<svg/>"])
def test_what_is_not_a_picture_is_refused(content: bytes) -> None:
    with pytest.raises(ReadError, match="PNG, JPEG, GIF or WebP"):
        UserImage.read(content)


def test_a_missing_picture_is_named(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"none\.png"):
        UserImage.read(tmp_path / "none.png")


def test_nouns_are_files_and_absent_ones_are_none(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        assert (run.requirements(), run.plan_text(), run.part("lid"), run.checks(), run.assembly(), run.script("lid")) == (None,) * 6
        run.save_requirements({"a": 1})
        run.save_plan("{}", 0)
        run.save_plan('{"b": 1}', 1)
        run.save_checks({"ok": True})
        run.save_assembly({"c": 1})
        run.save_attempt("lid", 1, script=b"x", outcome={"d": 1})
        (tmp_path / "solid").write_bytes(b"brep")
        run.save_part(
            "lid", record={"kernel": "k"}, script=b"s", brief={}, connectors={}, stl=b"t", files={"part.brep": tmp_path / "solid"}
        )

        assert run.plan_text() == '{"b": 1}'
        assert run.part("lid") == {"schema": "articad.part/1", "kernel": "k"}
        assert run.part_names() == ("lid",)
        assert run.script("lid") == b"s"
        assert run.attempt("lid", 1) == {"d": 1}
    files = {file.relative_to(tmp_path / "r").as_posix() for file in (tmp_path / "r").rglob("*") if file.is_file()}
    lid = {f"parts/lid/{name}" for name in ("script.py", "brief.json", "connectors.json", "part.json", "part.stl", "part.brep")}
    attempts = {"attempts/lid-1/script.py", "attempts/lid-1/outcome.json"}
    assert files == lid | attempts | {
        "request.json",
        "requirements.json",
        "plan.json",
        "plans/0.json",
        "plans/1.json",
        "checks.json",
        "assembly.json",
    }


def test_a_part_that_the_plan_dropped_is_put_aside_and_never_lost(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        for script in (b"one", b"two"):
            run.save_part("lid", record={}, script=script)
            run.remove_part("lid")
        assert run.part_names() == ()
    assert (tmp_path / "r/removed/lid/script.py").read_bytes() == b"two"


def test_a_part_counts_only_once_it_is_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        run.save_part("lid", record={"digest": "1"}, script=b"one")
        replace = Path.replace

        def dies_at_the_mesh(self: Path, target: Path) -> Path:
            if target.name.endswith(".stl"):
                raise KeyboardInterrupt
            return replace(self, target)

        monkeypatch.setattr(Path, "replace", dies_at_the_mesh)
        with pytest.raises(KeyboardInterrupt):
            run.save_part("lid", record={"digest": "2"}, script=b"two", stl=b"mesh")
        assert run.part("lid") is None


def test_a_second_answer_to_a_step_does_not_lose_the_first(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        run.save_reply("part/lid/1", {"key": "a" * 64, "reply": 1})
        run.save_reply("part/lid/1", {"key": "b" * 64, "reply": 2})

        assert run.replies() == ("part/lid/1",)
        assert run.reply("part/lid/1") == {"key": "b" * 64, "reply": 2}
    assert json.loads((tmp_path / "r/llm/superseded/part.lid.1.aaaaaaaa.json").read_text())["reply"] == 1


def test_two_writers_are_refused_and_readers_are_not(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r"):
        script = f"from articad.runs.run import Run; Run.view({str(tmp_path / 'r')!r}); Run.open({str(tmp_path / 'r')!r})"
        second = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        assert "RunError: Another process uses" in second.stderr
        with pytest.raises(RunError, match="Another process"):
            Run.open(tmp_path / "r")
    Run.open(tmp_path / "r").close()


def test_a_view_and_a_closed_run_write_nothing(tmp_path: Path) -> None:
    run = Run.create(request(), out=tmp_path / "r")
    run.close()
    for reader in (run, Run.view(tmp_path / "r")):
        with pytest.raises(RunError, match="reading only"):
            reader.save_plan("{}", 0)
        with pytest.raises(RunError, match="reading only"):
            reader.trace("note")


def test_a_directory_that_is_no_run_is_refused(tmp_path: Path) -> None:
    (tmp_path / "r").mkdir()
    with pytest.raises(RunError, match="is not a run"):
        Run.open(tmp_path / "r")
    (tmp_path / "r/thesis.tex").touch()
    with pytest.raises(RunError, match=r"holds thesis\.tex"):
        Run.create(request(), out=tmp_path / "r")
    (tmp_path / "r/request.json").write_text("{")
    with pytest.raises(ReadError, match="not JSON"):
        Run.open(tmp_path / "r")


def test_the_same_request_opens_its_run_again_and_another_does_not(tmp_path: Path) -> None:
    open_or_create(request(repairs=3), tmp_path / "r").close()
    with open_or_create(request(repairs=3), tmp_path / "r") as run:
        assert run.prompt == "a lamp"
    with pytest.raises(RunError, match="different request"):
        open_or_create(request(repairs=2), tmp_path / "r")
    Run.open(tmp_path / "r").close()  # the refusal left no lock


def test_a_creation_that_was_killed_can_be_repeated(tmp_path: Path) -> None:
    (tmp_path / "r/images").mkdir(parents=True)
    (tmp_path / "r/images/1.png").write_bytes(b"half")
    (tmp_path / "r/.articad-unfinished-0123abcd").write_text("{")
    with Run.create(RunRequest(prompt="x", images=(UserImage.read(PNG),)), out=tmp_path / "r"):
        assert (tmp_path / "r/images/1.png").read_bytes() == PNG
    assert not list((tmp_path / "r").glob(".*"))


def test_leftovers_of_a_killed_process_are_swept_when_it_is_opened(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        run.trace("note", text="before")
    (tmp_path / "r/.articad-unfinished-0123abcd").write_text("{")
    with (tmp_path / "r/trace.jsonl").open("ab") as stream:
        stream.write(b'{"t": 1, "event": "no')
    with Run.open(tmp_path / "r") as run:
        run.trace("note", text="after")
        assert [event["text"] for event in run.events()] == ["before", "after"]
    assert not list((tmp_path / "r").glob(".*"))


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EROFS, errno.EDQUOT, errno.EACCES])
def test_a_disk_that_refuses_gives_an_error_of_ours_and_keeps_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        run.save_plan("{}", 0)

        def refuses(_: int) -> None:
            raise OSError(code, os.strerror(code))

        monkeypatch.setattr(os, "fsync", refuses)
        with pytest.raises(WriteError, match="Cannot write") as caught:
            run.save_plan('{"b": 1}', 0)
        assert isinstance(caught.value, ArticadError)
        assert caught.value.findings.codes == ("E_WRITE",)
        assert run.plan_text() == "{}"
    assert not list((tmp_path / "r").rglob(".*"))


def test_a_folder_that_cannot_be_made_gives_an_error_of_ours(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(WriteError, match="Cannot write"):
        Run.create(request(), out=tmp_path / "file/r")


def test_exports_stay_in_their_folder(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        folder = run.save_export("urdf", {"a.urdf": b"<robot/>", "meshes/a.stl": b""}, {"ok": True})
        assert sorted(file.name for file in folder.rglob("*") if file.is_file()) == ["a.stl", "a.urdf", "losses.json"]
        with pytest.raises(RunError, match="outside"):
            run.save_export("urdf", {"../../plan.json": b""}, {})


def test_the_trace_keeps_every_line_of_every_thread(tmp_path: Path) -> None:
    with Run.create(request(), out=tmp_path / "r") as run:
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda n: run.trace("note", n=n), range(200)))
        events = list(run.events())
    assert {event["n"] for event in events} == set(range(200))
    assert all(set(event) == {"t", "event", "n"} for event in events)


def test_equal_work_gives_equal_files_and_a_difference_is_named(tmp_path: Path) -> None:
    runs = []
    for name in ("a", "b"):
        with Run.create(request(), out=tmp_path / name) as run:
            run.save_plan("{}", 0)
            run.trace("note")
            time.sleep(0.002)
        runs.append(Run.view(tmp_path / name))
    assert list(differences(*runs)) == []
    with Run.open(tmp_path / "b") as run:
        run.save_plan("[]", 1)
    assert list(differences(*runs)) == ["plan.json", "plans/1.json"]


def test_kill_nine_leaves_the_old_file_or_the_new_one(tmp_path: Path) -> None:
    script = """
import sys; from pathlib import Path; from articad.runs.run import write_atomically
n = 0
while True:
    n += 1
    write_atomically(Path(sys.argv[1]), str(n % 10).encode() * 300_000)
    if n == 3: print("going", flush=True)
"""
    target = tmp_path / "file"
    for delay in (0.0, 0.011, 0.023):
        process = subprocess.Popen([sys.executable, "-c", script, str(target)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(delay)
        process.send_signal(signal.SIGKILL)
        process.wait()
        process.stdout.close()
        content = target.read_bytes()
        assert len(content) == 300_000
        assert len(set(content)) == 1


def test_canonical_json_has_one_spelling() -> None:
    assert canonical_json({"b": 0.1, "a": ["ü", None]}) == '{"a":["ü",null],"b":0.1}'.encode()
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})
    with pytest.raises(ValueError, match="Out of range"):
        canonical_json(float("nan"))


def test_an_atomic_write_replaces(tmp_path: Path) -> None:
    write_atomically(tmp_path / "deep/file", b"1")
    write_atomically(tmp_path / "deep/file", b"2")
    assert (tmp_path / "deep/file").read_bytes() == b"2"


def stored_request(folder: Path, **changed: object) -> Path:
    with Run.create(RunRequest(prompt="a box", options={"rounds": 1}), out=folder) as run:
        path = run.path / "request.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changed))
    return folder


@pytest.mark.parametrize("name", ["../secret.png", "/etc/secret.png", "images/../../secret.png", "images/1.png/../1.png", "secret.png"])
def test_a_strangers_run_cannot_have_other_pictures_sent_to_a_model(tmp_path: Path, name: str) -> None:
    (tmp_path / "secret.png").write_bytes(b"\x89PNG\r\n\x1a\n secret")
    folder = stored_request(tmp_path / "run", images=[{"file": name, "sha256": ""}])
    (folder / "secret.png").write_bytes(b"\x89PNG\r\n\x1a\n secret")

    with pytest.raises(RunError, match="not in the run"):
        Run.view(folder)


def test_a_picture_that_is_a_link_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.png").write_bytes(b"\x89PNG\r\n\x1a\n secret")
    folder = stored_request(tmp_path / "run", images=[{"file": "images/1.png", "sha256": ""}])
    (folder / "images").mkdir()
    (folder / "images" / "1.png").symlink_to(tmp_path / "secret.png")

    with pytest.raises(RunError, match="neither a file nor a folder"):
        Run.view(folder)


@pytest.mark.parametrize("place", ["trace.jsonl", "parts", "export", "export/urdf", "request.json"])
@pytest.mark.parametrize("kind", ["link", "link to nothing", "pipe"])
def test_a_strangers_run_that_leads_out_of_itself_is_not_opened(tmp_path: Path, place: str, kind: str) -> None:
    """Writing to a run would follow its links, and a pipe would block forever."""
    folder, outside = tmp_path / "run", tmp_path / "outside"
    Run.create(RunRequest(prompt="a box"), out=folder).close()
    outside.mkdir()
    target = folder / place
    target.parent.mkdir(exist_ok=True)
    target.unlink(missing_ok=True)
    if kind == "pipe":
        os.mkfifo(target)
    else:
        target.symlink_to(outside if kind == "link" else outside / "new")

    for way in (Run.open, Run.view):
        with pytest.raises(RunError, match=f"{target.name} is neither a file nor a folder"):
            way(folder)
    assert list(outside.iterdir()) == []


@pytest.mark.parametrize("name", ["/etc/passwd", "../../../secret", "meshes/../../../secret"])
def test_a_strangers_export_cannot_name_files_outside(tmp_path: Path, name: str) -> None:
    Run.create(RunRequest(prompt="a box"), out=tmp_path / "run").close()
    folder = tmp_path / "run" / "export" / "urdf"
    folder.mkdir(parents=True)
    (folder / "losses.json").write_text(json.dumps({"ok": True, "findings": [], "rows": [], "files": {name: 3}}))

    with pytest.raises(ReadError, match="outside its folder"):
        Run.view(tmp_path / "run").exports()
    (folder / "losses.json").write_text(json.dumps({"ok": True, "findings": [], "rows": [], "files": [3]}))
    with pytest.raises(ReadError, match="files"):
        Run.view(tmp_path / "run").exports()


def test_a_run_may_itself_be_reached_by_a_link(tmp_path: Path) -> None:
    Run.create(RunRequest(prompt="a box"), out=tmp_path / "run").close()
    (tmp_path / "latest").symlink_to(tmp_path / "run")

    with Run.open(tmp_path / "latest") as run:
        assert run.prompt == "a box"


@pytest.mark.parametrize("changed", [{"images": 3}, {"images": [3]}, {"images": [{}]}, {"prompt": None}, {"options": []}])
def test_an_incomplete_request_is_an_error_of_ours(tmp_path: Path, changed: dict[str, object]) -> None:
    with pytest.raises(RunError, match="incomplete"):
        Run.view(stored_request(tmp_path / "run", **changed))


@pytest.mark.parametrize("content", [b"[" * 100_000, b'{"a": NaN}', b"\xff", b"3"])
def test_a_spoiled_file_of_a_run_is_an_error_of_ours(tmp_path: Path, content: bytes) -> None:
    folder = stored_request(tmp_path / "run")
    (folder / "checks.json").write_bytes(content)
    (folder / "trace.jsonl").write_bytes(b"3\n" + content + b'\n{"t": 1}\n')

    run = Run.view(folder)
    with pytest.raises(ReadError):
        run.checks()
    assert [event["t"] for event in run.events() if "t" in event] == [1]
