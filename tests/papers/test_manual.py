"""The assembly manual: a page a step, new parts on the proven path, callouts that point at them, and a page that plays the steps."""

from __future__ import annotations

import io
import itertools
import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from articad import cli
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.steps import AssemblyOrder, shown_path
from articad.geometry.part import Part
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from articad.papers.items import items_of
from articad.papers.manual import NEW, PAGE, manual_of
from articad.papers.sheet import DrawingSheet, fitted, text_width
from articad.papers.writers import written_pdf, written_svg
from articad.report import Documents, report_page
from tests.disassembly.test_order import BOX, INSIDE, LID, block
from tests.interference.mechanisms import fixed, joint, manifold_mesh
from tests.papers.test_drawings import boxes

PEG = block((18, 20), (18, 20), (20, 23))


@cache
def boxed() -> Assembly:
    """A box with a thing and, on it, a small peg; and a lid that is glued on."""
    solids = {"box": BOX, "thing": INSIDE, "lid": LID, "peg": PEG}
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in solids.items()]
    glued = replace(fixed("glue", "box", "lid"), fastening="adhesive")
    joints = [joint("slide", "slider", "box", "thing", lower=(0.0,), upper=(5.0,)), glued, fixed("stud", "thing", "peg")]
    return Assembly.from_parts("boxed", parts=parts, joints=joints, ground="box")


@cache
def order() -> AssemblyOrder:
    return boxed().assembly_order()


@cache
def pages() -> tuple[DrawingSheet, ...]:
    return tuple(manual_of(boxed(), order(), items_of(boxed()), dots=2.0))


def steps() -> list[DrawingSheet]:
    return [page for page in pages() if page.told["page"] == "step"]


def picture(page: DrawingSheet) -> Any:
    return np.asarray(Image.open(io.BytesIO(page.pictures[0].png)).convert("RGB")).astype(int)


def test_there_is_a_page_for_each_step_with_the_items_that_are_new() -> None:
    assert [page.told["page"] for page in pages()[:2]] == ["cover", "items"]
    assert [page.told["step"] for page in steps()] == [step.number for step in order().steps]
    number = {part: item.number for item in items_of(boxed()) for part in item.parts}
    for page, step in zip(steps(), order().steps, strict=True):
        new = sorted({number[part] for part in step.parts})
        assert page.told["items"] == new
        assert page.told["callouts"] == new
        assert {str(n) for n in new} <= {text.words for text in page.texts}


def test_items_with_long_names_that_begin_alike_are_told_apart() -> None:
    names = ["bucket_ram_barrel_left", "bucket_ram_barrel_rear"]
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in zip(names, (BOX, LID), strict=True)]
    product = Assembly.from_parts("rams", parts=parts, joints=[fixed("weld", *names)], ground=names[0])
    page = next(page for page in manual_of(product, product.assembly_order(), items_of(product), dots=1.0) if page.told["page"] == "items")
    assert set(names) <= {text.words for text in page.texts}
    assert len(boxes(page)) > 0


def test_the_cover_accounts_for_every_step() -> None:
    (told,) = [text.words for text in pages()[0].texts if text.words.startswith("The paths of")]
    paths, starts = (int(word) for word in told.replace(";", " ").split() if word.isdigit())
    permitted = sum(step.strength == "permitted" for step in order().steps)
    assert paths + starts + permitted == len(order().steps)


def test_new_parts_and_no_others_are_drawn_in_colour() -> None:
    wanted = np.array([int(NEW[at : at + 2], 16) for at in (1, 3, 5)])
    for page, step in zip(steps(), order().steps, strict=True):
        pixels = picture(page)
        coloured = (pixels.max(axis=2) - pixels.min(axis=2)) > 60
        hue = pixels[coloured].mean(axis=0)
        assert 0.0005 < coloured.mean() < 0.5, step.parts
        assert hue / hue.max() == pytest.approx(wanted / wanted.max(), abs=0.08)
        if step.onto:
            assert ((pixels.max(axis=2) < 240) & ~coloured).any()  # what is in place is grey


def test_new_parts_are_shown_on_a_path_on_which_they_meet_nothing() -> None:
    """Booleans of the solids at points all along what is shown."""
    meshes = boxed().scene().meshes
    for step in order().steps:
        path = shown_path(step, 70.0)
        assert path[-1] == pytest.approx([0, 0, 0])
        for a, b in itertools.pairwise(path):
            for share in np.linspace(0, 1, 25):
                T = SE3.from_translation(a + share * (b - a))
                for part, other in itertools.product(step.parts, step.onto):
                    assert overlap(body_of(meshes[other]), body_of(meshes[part]), T).depth < 0.1


def test_small_parts_are_shown_in_a_close_up() -> None:
    counts = {step.parts: len(page.pictures) for page, step in zip(steps(), order().steps, strict=True)}
    assert counts[("peg",)] == 2
    assert counts[("box",)] == 1


def test_a_page_keeps_the_view_of_its_own_assembly() -> None:
    """A case that is open below gets a thing from there; the first part of a sub-assembly is not seen from below for that."""
    turned = {name: solid.rotate((180, 0, 0)) for name, solid in {"box": BOX, "thing": INSIDE, "lid": LID}.items()}
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in turned.items()]
    product = Assembly.from_parts("case", parts=parts, joints=[fixed("one", "box", "thing"), fixed("two", "box", "lid")], ground="box")
    order = product.assembly_order()
    box, *inside = order.steps
    of_another = box.model_copy(update={"assembly": "drawer", "parts": ("lid",)})
    longer = order.model_copy(update={"steps": (box, *inside, of_another, inside[0])})
    told = [page.told for page in manual_of(product, longer, items_of(product), dots=1.0)]
    views = [str(page["view"]) for page in told if page["page"] == "step"]

    assert "below" in views[1]
    assert views[-2] == "iso"
    assert "below" in views[-1]


def test_words_state_how_parts_are_fastened_and_what_is_proven() -> None:
    words = [" ".join(text.words for text in page.texts) for page in steps()]
    (lid,) = (text for text, step in zip(words, order().steps, strict=True) if step.parts == ("lid",))
    assert "lid stays fixed to box, and is glued." in lid
    assert "from above" in lid
    assert "proven free of collisions" in lid


@pytest.mark.parametrize("index", range(6))
def test_no_text_overlaps_another_or_leaves_the_page(index: int) -> None:
    found = boxes(pages()[index])
    assert [words for words, x0, y0, x1, y1 in found if x0 < 5 or y0 < 5 or x1 > PAGE[0] - 5 or y1 > PAGE[1] - 5] == []
    crossing = [(a[0], b[0]) for a, b in itertools.combinations(found, 2) if a[1] < b[3] and b[1] < a[3] and a[2] < b[4] and b[2] < a[4]]
    assert crossing == []


def test_parts_that_no_order_takes_are_named_on_the_cover_and_on_their_page() -> None:
    parts = [Part.from_mesh(name, manifold_mesh(solid)) for name, solid in {"box": BOX + LID, "thing": INSIDE}.items()]
    product = Assembly.from_parts("closed", parts=parts, joints=[fixed("f", "box", "thing")], ground="box")
    made = list(manual_of(product, product.assembly_order(), items_of(product), dots=1.0))
    for page in (made[0], made[-1]):
        assert "No order was found that puts these" in " ".join(text.words for text in page.texts)


def test_pdf_has_all_pages_and_svg_its_picture() -> None:
    pytest.importorskip("reportlab")
    content = written_pdf(pages(), "boxed")
    assert content.count(b"/Type /Page\n") == len(pages())
    assert content == written_pdf(pages(), "boxed")
    assert written_svg(steps()[1]).count(b"data:image/png;base64,") == len(steps()[1].pictures)


def test_the_page_holds_the_steps_and_their_paths() -> None:
    page = report_page(boxed(), Documents(order=order().to_json()))
    model = json.loads(page.split('id="model">')[1].split("</script>")[0])
    shown = model["order"]["steps"]
    names = [part["name"] for part in model["parts"]]
    assert [tuple(names[at] for at in step["parts"]) for step in shown] == [step.parts for step in order().steps]
    assert page.count('aria-label="Play step') == len(order().steps)


def test_the_command_writes_the_manual(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.commands.papers.loaded", lambda *_: boxed())
    assert cli.main(["manual", str(tmp_path), "--to", "html", "--out", str(tmp_path / "out"), "-q"]) == 0
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["boxed_manual.html"]


@pytest.mark.parametrize("width", [4.0, 10.0, 18.0, 30.0])
@pytest.mark.parametrize("names", [("boom_ram_barrel", "boom_ram_rod"), ("bucket_ram_barrel", "bucket_ram_rod")])
def test_a_shortened_name_fits_and_keeps_both_its_ends(names: tuple[str, ...], width: float) -> None:
    for name in names:
        shown = fitted(name, width, 2.5)
        assert text_width(shown, 2.5) <= width
        head, dots, tail = shown.partition("...")
        assert name.startswith(head)
        assert name.endswith(tail) or not dots
    if width >= 18.0:
        assert len({fitted(name, width, 2.5) for name in names}) == len(names)
