"""`articad edit`: numbers without a model, words with one; what it prints is the proof."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from articad import cli
from articad.agents.llm import Scripted
from articad.agents.pipeline import generate
from articad.runs.run import Run
from tests.agents import stories

THICKER = {"summary": "A thicker flap.", "touches": ["flap"], "changes": {"parts.flap.dimensions.thickness": 3}}
REVIEWED = json.dumps({aspect: {"score": 4, "reason": "as asked"} for aspect in ("geometry", "detail", "motion")} | {"lessons": []})


@pytest.fixture(autouse=True)
def quiet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARTICAD_MEMORY", str(tmp_path / "memory"))
    monkeypatch.setenv("ARTICAD_CACHE", str(stories.shared_cache().root))
    for place in ("articad.runs.record.kernel_named", "articad.agents.settings.kernel_named"):
        monkeypatch.setattr(place, lambda *_, **__: stories.kernel())


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("plate") / "run"
    options: dict[str, Any] = {"look": False, "inspection": False}
    return generate(
        stories.FLAP_PROMPT,
        llm=stories.flap(),
        out=folder,
        **stories.settings(kernel=stories.kernel(), cache=stories.shared_cache(), **options),
    )


def test_numbers_alone_ask_nobody_and_print_what_changed(plate: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["edit", str(plate.path), "--set", "lift=2", "--out", str(tmp_path / "run"), "--no-pictures"]) == 0
    told = capsys.readouterr().out

    for words in (
        "Edit: lift = 2",
        "parameters.lift.value",
        "untouched",
        "rebuilt",
        "8 of 8",
        "Untouched: 1 part, 8 files equal by sha256.",
    ):
        assert words in told
    assert "Model:" not in told
    assert Run.view(tmp_path / "run").replies() == ()


def test_words_ask_a_model_and_are_remembered_with_what_was_edited(
    plate: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    model = Scripted({"edit/1": json.dumps(THICKER), "review": REVIEWED} | stories.watched("hinge"))
    monkeypatch.setattr("articad.agents.live.LiteLLM", lambda *_, **__: model)
    code = cli.main(["edit", str(plate.path), "a thicker flap", "--review", "--out", str(tmp_path / "run"), "--no-pictures", "--json"])
    report = json.loads(capsys.readouterr().out)

    assert (code, report["ok"], report["edit"]["summary"]) == (0, True, "A thicker flap.")
    assert report["model"]["calls"] == len(model.requests)
    assert report["review"]["model"]["geometry"]["score"] == 4
    assert cli.main(["memory", "list", "--json"]) == 0
    (case,) = json.loads(capsys.readouterr().out)["cases"]
    assert case["prompt"] == f"{stories.FLAP_PROMPT}\n\nChanged since: a thicker flap"


def test_a_run_that_was_interrupted_is_resumed_by_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("articad.agents.settings.kernel_named", lambda *_, **__: stories.kernel())
    model = stories.flap()
    monkeypatch.setattr("articad.agents.live.LiteLLM", lambda *_, **__: model)
    run = str(tmp_path / "run")
    asked = ["generate", stories.FLAP_PROMPT, "--out", run, "--no-look", "--no-inspection", "--no-pictures", "--max-calls", "2"]
    assert cli.main(asked) == 3
    assert "resume" in capsys.readouterr().err
    assert cli.main(["resume", run, "--no-pictures", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["model"]["calls"] == 2
    assert len(model.requests) == 4


def test_an_edit_of_nothing_and_of_no_run_is_refused(plate: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["edit", str(plate.path)]) == 3
    assert "No change is given" in capsys.readouterr().err
    assert cli.main(["edit", str(tmp_path), "wider", "--model", "none/none"]) == 3


@pytest.mark.freecad
def test_a_feature_tree_is_edited_and_the_other_document_stays_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    for line in (
        "new box --kernel freecad",
        "build box --out run --no-pictures --export urdf",
        "edit run --set height=40 --out taller --no-pictures --export urdf --json",
    ):
        capsys.readouterr()
        assert cli.main(line.split()) == 0
    parts = json.loads(capsys.readouterr().out)["edit"]["parts"]

    assert (parts["lid"]["fate"], parts["tray"]["fate"]) == ("untouched", "rebuilt")
    assert "part.FCStd" in parts["tray"]["different"]
    assert (tmp_path / "run/parts/lid/part.FCStd").read_bytes() == (tmp_path / "taller/parts/lid/part.FCStd").read_bytes()
