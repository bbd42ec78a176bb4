"""Documents of others are read as FreeCAD has them, or refused with the joint or the file; the comparison itself is tested on documents of ours."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from tests.freecad import opened, public_documents
from tests.freecad.public_documents import DOCUMENTS, Document, Json, judge, read, seen

HERE = Path(__file__).parent
PLANTED: dict[str, Callable[[Json], Any]] = {  # what FreeCAD might have found otherwise
    "pose": lambda seen: seen["parts"][-1]["pose"][0].__setitem__(3, seen["parts"][-1]["pose"][0][3] + 1e-4),
    "volume": lambda seen: seen["parts"][-1]["solids"][0].update(volume=seen["parts"][-1]["solids"][0]["volume"] * (1 + 1e-5)),
    "density": lambda seen: seen["parts"][-1].update(densities=[7850.0]),
    "part": lambda seen: (seen["parts"].append(seen["parts"][-1]), seen["solved"].append(seen["solved"][-1])),
    "solid": lambda seen: seen["parts"][-1]["solids"].append(seen["parts"][-1]["solids"][0]),
    "frame": lambda seen: seen["joints"][0]["frames"][1][2].__setitem__(3, seen["joints"][0]["frames"][1][2][3] + 1e-4),
    "joint": lambda seen: seen["joints"].append(seen["joints"][0] | {"label": "Forgotten"}),
    "pair": lambda seen: seen["joints"][0].update(parts=[1, 2]),
}


@pytest.mark.freecad
@opened.needs_freecad
def test_the_comparison_finds_what_is_planted(tmp_path: Path) -> None:
    freecad = freecad_install.find()
    ended = freecad.run(HERE / "by_hand_linked.py", folder=tmp_path)
    assert (tmp_path / "assembled.FCStd").is_file(), ended.said
    document = Document("hand", "", "", "assembled.FCStd")
    made, report = read_freecad(tmp_path / "assembled.FCStd"), seen(tmp_path / "assembled.FCStd", freecad)
    found, wrong = judge(document, made, report)
    assert not wrong
    assert found is not None
    assert (found.parts, found.joints) == (len(made.parts), len(report["joints"]))
    assert found.mm < 1e-9

    for change, plant in PLANTED.items():
        other = copy.deepcopy(report)
        plant(other)
        assert judge(document, made, other)[1], change
    assert judge(document, "It cannot be read.", report)[1], "a refusal that names nothing"


def test_a_refusal_has_to_name_what_the_table_says() -> None:
    refused = next(document for document in DOCUMENTS if document.refused)
    assert not judge(refused, f"Joint {refused.refused!r} cannot be read.", {})[1]
    assert judge(refused, "It cannot be read.", {})[1]


@pytest.mark.corpus
@pytest.mark.freecad_next
@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: document.name)
def test_a_public_document_is_read_as_freecad_has_it_or_refused_by_name(document: Document) -> None:
    if not public_documents.FOLDER:
        pytest.skip("set ARTICAD_FREECAD_DOCUMENTS to a folder with the repositories: python -m tests.freecad.public_documents --list")
    made = read(document)
    versions = public_documents.able(document)
    assert versions
    for freecad in versions:
        assert not judge(document, made, seen(document.file, freecad))[1]
