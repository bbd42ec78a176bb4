"""Every control of the page does what it says: on a desktop, a tablet and a phone, in light and in dark."""

from __future__ import annotations

import io
import json
import math
import os
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from articad import cli
from articad.assembly import Assembly
from articad.commands.watching import PageServer
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kinematics import declare
from articad.report import Documents, report_page
from tests.assemblies import four_bar
from tests.report.conftest import Opened
from tests.report.test_page import ROOT, assert_silent, contrast, error_of, hinged, on_screen, pulled

Open = Callable[..., Opened]
SCREENS: dict[str, dict[str, Any]] = {
    "desktop light": {"width": 1280, "height": 720},
    "tablet dark": {"width": 820, "height": 1180, "scheme": "dark", "phone": True},
    "phone light": {"width": 390, "height": 844, "phone": True},
    "phone dark": {"width": 390, "height": 844, "scheme": "dark", "phone": True},
    "desktop dark": {"width": 1280, "height": 720, "scheme": "dark"},
}
HIDDEN = "articad.view.groups.filter(g => !g.visible).map(g => g.name)"


def checked(assembly: Assembly) -> Documents:
    return Documents(checks=assembly.check().to_json(), plan="{}")


@pytest.fixture(params=SCREENS)
def screen(request: pytest.FixtureRequest) -> dict[str, Any]:
    return SCREENS[str(request.param)]


def frame(opened: Opened) -> None:
    """Wait until the next picture is drawn."""
    opened("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def test_selection_and_sliders_do_what_they_say(open_page: Open, screen: dict[str, Any]) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly, checked(assembly)), **screen)
    page = opened.page

    # A click on a part selects it in the picture and in the table; the card says what is known about it.
    page.mouse.click(*on_screen(opened, "base", [0.0, -20.0, 0.0]))
    assert opened("articad.view.groups[0].userData.materials[0].emissive.getHex() > 0")
    assert opened("[...document.querySelectorAll('tr.selected [data-part]')].map(b => b.textContent)") == ["base"]
    card = page.inner_text("#card")
    assert all(words in card for words in ("base", "oak", "0.04704 kg", "60.0 × 40.0 × 28.0 mm", "hinge (revolute)", "not certified")), card
    page.click("#card-hide")
    assert opened(HIDDEN) == ["base"]
    assert not opened("document.querySelector('[data-visible=\"0\"]').checked")
    page.click("#card-hide")
    page.click("#card-alone")
    assert opened("articad.view.groups.map(g => g.userData.materials[0].opacity < 1)") == [False, True, True]
    page.click("#card-alone")
    page.locator('[data-part="1"]').click()
    assert opened("articad.view.selected") == 1
    page.locator("#card button[aria-label=deselect]").click()
    assert page.locator("#card").is_hidden()

    # A slider moves its joint and stands within its limits, which are written beside it.
    slider = page.locator("#drivers input[type=range]").first
    slider.evaluate("s => { s.value = 999; s.dispatchEvent(new Event('input')) }")
    assert opened("articad.q().hinge") == pytest.approx(1.8)
    number = page.locator("#drivers input[type=number]").first
    number.fill("-50")
    number.dispatch_event("change")
    assert opened("articad.q().hinge") == 0.0
    assert opened("[...document.querySelectorAll('.limits')].map(each => each.textContent)") == ["0.0° … 103.1°", "-20.0 mm … 20.0 mm"]
    page.click("#reset")
    assert opened("articad.q()") == {driver.name: driver.rest for driver in assembly.drivers}
    assert_silent(opened)


def test_views_sections_names_and_theme_do_what_they_say(open_page: Open, screen: dict[str, Any]) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly, checked(assembly)), **screen)
    page = opened.page

    # Views, parallel rays, frames of joints, names.
    for view, away in (("front", [0, -1, 0]), ("right", [1, 0, 0])):
        page.click(f"[data-view={view}]")
        direction = np.array(opened("articad.view.camera.position.clone().sub(articad.view.controls.target).normalize().toArray()"))
        assert direction == pytest.approx(away, abs=1e-3)
    page.click("[data-view=iso]")
    before = on_screen(opened, "base", [30.0, -20.0, 0.0])
    page.click("#tool-parallel")
    assert opened("articad.view.camera.isOrthographicCamera")
    assert math.dist(before, on_screen(opened, "base", [30.0, -20.0, 0.0])) < 40, "the model keeps its size on the screen"
    page.click("#tool-parallel")
    assert on_screen(opened, "base", [30.0, -20.0, 0.0]) == pytest.approx(before, abs=1)
    page.click("#tool-axes")
    assert opened("articad.view.axes.visible")
    page.click("#tool-axes")
    page.click("#tool-names")
    frame(opened)
    assert opened("[...document.querySelectorAll('#labels .part')].filter(e => !e.hidden).map(e => e.textContent)") == [
        "base",
        "lid",
        "puck",
    ]
    page.click("#tool-names")

    # Up to three sections, each with the other side.
    page.locator(".menu summary", has_text="section").click()
    for count, axis in enumerate("xyz", start=1):
        page.locator(f"#cut-{axis}").check()
        assert opened("articad.view.planes.length") == count
    normals = opened("articad.view.planes.map(p => p.normal.toArray())")
    page.locator("#cut-x-flip").check()
    assert opened("articad.view.planes[0].normal.x") == -normals[0][0]
    for axis in "xyz":
        page.locator(f"#cut-{axis}").uncheck()
    assert opened("articad.view.planes.length") == 0
    page.locator(".menu summary", has_text="section").click()

    theme = opened("getComputedStyle(document.body).backgroundColor")
    page.click("#theme")
    assert opened("getComputedStyle(document.body).backgroundColor") != theme
    assert opened("document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than the screen"
    assert_silent(opened)


def test_the_cube_turns_with_the_camera_and_each_face_looks_at_its_side(open_page: Open, screen: dict[str, Any]) -> None:
    opened = open_page(report_page(hinged()), **screen)
    shown = "[...document.querySelectorAll('#cube g')].filter(g => g.style.display !== 'none').map(g => g.textContent)"
    looking = (
        "() => { articad.view.draw(); return articad.view.camera.position.clone().sub(articad.view.controls.target).normalize().toArray() }"
    )

    assert sorted(opened(shown)) == ["front", "right", "top"]
    opened.page.locator("#cube g", has_text="right").click()
    assert opened(looking) == pytest.approx([1, 0, 0], abs=1e-3)
    assert opened(shown) == ["right"]
    opened("() => { articad.view.turn(0.6, 0.4); articad.view.draw() }")
    assert sorted(opened(shown)) == ["back", "right", "top"]
    assert_silent(opened)


def test_names_keep_clear_of_each_other(open_page: Open) -> None:
    """Seen from above, base and lid have their middles at the same place."""
    opened = open_page(report_page(hinged()))
    opened.page.click("[data-view=top]")
    opened.page.click("#tool-names")
    opened("articad.view.draw()")

    boxes = opened(
        "[...document.querySelectorAll('#labels .part')].map(e => { const b = e.getBoundingClientRect(); return [b.left, b.top, b.right, b.bottom] })"
    )
    assert len(boxes) == 3
    for index, (left, top, right, bottom) in enumerate(boxes):
        for other in boxes[:index]:
            assert left >= other[2] or right <= other[0] or top >= other[3] or bottom <= other[1], boxes
    assert opened("[...document.querySelectorAll('#leaders line')].some(line => line.style.display === '')"), "one is led to its place"


def test_a_dragged_part_stays_under_the_pointer(open_page: Open, screen: dict[str, Any]) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly), **screen)
    corner = [20.0, -36.0, 4.0]
    for value in (0.5, 1.2):
        opened("value => articad.set({ hinge: value })", value)
        end = on_screen(opened, "lid", corner)
        opened("articad.set({ hinge: 0 })")

        pulled(opened, on_screen(opened, "lid", corner), end)

        assert math.dist(on_screen(opened, "lid", corner), end) < 2, "pixels"
        assert opened("articad.q().hinge") == pytest.approx(value, abs=0.03)
        assert error_of(opened, assembly, assembly.q(hinge=opened("articad.q().hinge"))) < 1e-9
    assert_silent(opened)


def test_a_finger_moves_a_joint(open_page: Open) -> None:
    opened = open_page(report_page(hinged()), **SCREENS["phone light"])
    corner = [20.0, -36.0, 4.0]
    opened("articad.set({ hinge: 0.8 })")
    end = on_screen(opened, "lid", corner)
    opened("articad.set({ hinge: 0 })")
    start = on_screen(opened, "lid", corner)
    touch = opened.page.context.new_cdp_session(opened.page)

    for kind, share in (("touchStart", 0.0), ("touchMove", 0.3), ("touchMove", 0.7), ("touchMove", 1.0), ("touchEnd", None)):
        points = (
            []
            if share is None
            else [{"x": s + share * (e - s), "y": t} for s, e, t in [(start[0], end[0], start[1] + share * (end[1] - start[1]))]]
        )
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    assert opened("articad.q().hinge") == pytest.approx(0.8, abs=0.05)


@pytest.mark.parametrize("make", [hinged, four_bar], ids=lambda make: make.__name__)
def test_play_moves_every_joint_with_its_loops_and_stops(open_page: Open, make: Callable[[], Assembly]) -> None:
    assembly = make()
    opened = open_page(report_page(assembly))
    page = opened.page

    page.click("#play")
    page.wait_for_function(
        "rest => Object.keys(rest).every(name => Math.abs(articad.q()[name] - rest[name]) > 1e-3)",
        arg={assembly.drivers[0].name: assembly.drivers[0].rest},
    )
    page.click("#play")
    q = opened("articad.q()")
    frame(opened)
    assert opened("articad.q()") == q, "it stands still"
    values = np.array([q[driver.name] for driver in assembly.drivers])
    assert error_of(opened, assembly, values) < 1e-9, "loops are closed"
    page.locator("#drivers .play").last.click()
    last = assembly.drivers[-1].name
    page.wait_for_function("([name, value]) => Math.abs(articad.q()[name] - value) > 1e-3", arg=[last, q[last]])
    page.keyboard.press("r")
    assert opened("articad.q()")[last] == pytest.approx(assembly.drivers[-1].rest)
    assert opened("document.querySelectorAll('#play[aria-pressed=true], .play[aria-pressed=true]').length") == 0
    assert_silent(opened)


@pytest.mark.parametrize("beyond", [1.7, 2.5, 4.0, 7.3], ids=str)
def test_a_loop_that_stood_at_its_dead_point_goes_back_on_its_branch(open_page: Open, beyond: float) -> None:
    """Links of 30 and 163 mm, 90 and 70 mm: the crank's branch ends at 91.6°, where another one begins."""
    assembly = four_bar()
    name = assembly.drivers[0].name
    opened = open_page(report_page(assembly))

    for back in (assembly.drivers[0].rest, 0.3, 1.54, 1.59):
        assert not opened(f"articad.set({{ {name}: {beyond} }})")
        assert opened(f"articad.q()['{name}']") == pytest.approx(1.599, abs=1e-3), "it stands at the dead point"
        assert opened(f"articad.set({{ {name}: {back} }})")
        assert error_of(opened, assembly, np.array([back])) < 1e-9


def test_a_link_restores_pose_camera_hidden_parts_sections_and_explosion(open_page: Open) -> None:
    text = report_page(hinged())
    opened = open_page(text)
    page = opened.page
    opened("articad.set({ hinge: 0.7, rail: -12.5 })")
    page.locator("#explode").evaluate("s => { s.value = 0.4; s.dispatchEvent(new Event('input')) }")
    page.locator('[data-visible="2"]').uncheck()
    page.locator(".menu summary", has_text="section").click()
    page.locator("#cut-z").check()
    page.click("[data-view=right]")
    opened("articad.view.turn(0.3, 0.2)")
    page.locator(".menu summary", has_text="section").click()
    page.locator(".menu summary", has_text="save").click()
    page.click("#link")
    page.wait_for_function("() => location.hash.length > 2")
    here, state, drawn = opened("location.href"), opened("articad.state()"), opened("articad.drawn()")

    other = page.context.new_page()
    other.goto(here)
    other.wait_for_selector("html[data-ready]", state="attached")

    assert other.evaluate("articad.state()") == state
    assert other.evaluate("articad.drawn()") == drawn
    assert other.evaluate(HIDDEN) == ["puck"]
    assert other.evaluate("articad.view.planes.length") == 1
    other.evaluate("location.hash = '#%7Bnonsense'")
    other.reload()
    other.wait_for_selector("html[data-ready]", state="attached")
    assert "cannot be read" in other.inner_text("#status")


def test_a_linked_page_plays_unless_motion_is_unwanted(open_page: Open, chromium: Any, tmp_path: Path) -> None:
    file = tmp_path / "plays.html"
    file.write_text(report_page(hinged()), encoding="utf-8")
    for motion, plays in (("no-preference", "true"), ("reduce", "false")):
        context = chromium.new_context(reduced_motion=motion)
        page = context.new_page()
        page.goto(file.as_uri() + "#moving")
        page.wait_for_selector("html[data-ready]", state="attached")
        assert page.get_attribute("#play", "aria-pressed") == plays
        context.close()


def saved(opened: Opened, button: str) -> bytes:
    """Press a button of the save menu and return the file that it makes."""
    if not opened.page.locator(f"#{button}").is_visible():
        opened.page.locator(".menu summary", has_text="save").click()
    with opened.page.expect_download(timeout=240_000) as download:
        opened.page.click(f"#{button}")
    return Path(download.value.path()).read_bytes()


def test_pictures_and_films_are_saved(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly), width=700, height=420)

    with Image.open(io.BytesIO(saved(opened, "save-png"))) as picture:
        canvas = opened("[articad.view.canvas.clientWidth, articad.view.canvas.clientHeight]")
        assert list(picture.size) == canvas
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    assert pixels[2, 2].min() > 235, "the light background"
    assert (np.abs(pixels - pixels[2, 2]).max(axis=-1) > 40).mean() > 0.05, "the model is there"
    with Image.open(io.BytesIO(saved(opened, "save-gif"))) as film:
        assert film.format == "GIF"
        assert getattr(film, "n_frames", 1) == 40
        frames = []
        for index in (0, 6, 17):
            film.seek(index)
            frames.append(np.asarray(film.convert("RGB")).astype(int))
    assert all((np.abs(a - b).max(axis=-1) > 40).mean() > 0.01 for a, b in pairwise(frames)), "it moves"
    assert np.abs(frames[0][2, 2] - pixels[2, 2]).max() < 12, "the palette keeps colours"
    webm = saved(opened, "save-webm")
    assert webm[:4] == b"\x1a\x45\xdf\xa3"
    assert b"webm" in webm[:64]
    assert len(webm) > 5_000
    assert opened("articad.q()") == {driver.name: driver.rest for driver in assembly.drivers}, "the model stands as before"


def test_corners_edges_faces_and_axes_are_measured(open_page: Open) -> None:
    opened = open_page(report_page(hinged()))
    page = opened.page
    page.click("#tool-parallel")

    def measured(view: str, *points: tuple[str, list[float]]) -> str:
        page.click(f"[data-view={view}]")
        frame(opened)
        if opened("document.querySelector('#tool-measure').ariaPressed") == "true":
            page.click("#tool-measure")
        page.click("#tool-measure")
        for part, local in points:
            page.mouse.click(*on_screen(opened, part, local))
        return str(page.inner_text("#measured"))

    # The base is 60 × 40 × 28 about its middle; the lid, 4 thick, lies on top of it with its hinge at the back.
    edge = measured("front", ("base", [10.0, -20.0, -14.0]), ("lid", [10.0, -40.0, 4.0]))
    assert "edge, 60.000 mm long" in edge
    assert "parallel" in edge
    faces = measured("front", ("base", [3.0, -20.0, 0.0]), ("base", [-12.0, -20.0, 4.0]))
    assert "0.000 mm, parallel (face; face)" in faces
    turned = measured("iso", ("base", [3.0, -20.0, 0.0]), ("base", [30.0, 3.0, 0.0]))
    assert "90.00° (face; face)" in turned
    beside = measured("front", ("base", [10.0, -20.0, -14.02]), ("base", [3.0, -20.0, 0.0]))
    assert "edge, 60.000 mm long; face" in beside, "an outline is caught from just beside it"
    corner = measured("front", ("base", [30.0, -20.0, -14.0]), ("base", [-30.0, -20.0, -14.0]))
    assert corner.startswith("base – base: 60.000 mm (Δx -60.000, Δy 0.000, Δz 0.000)")
    assert_silent(opened)


def test_an_overlap_is_red_and_the_camera_flies_to_it(open_page: Open) -> None:
    base = Part.from_mesh("base", box(60, 40, 28), connectors={"rail": Connector("rail", SE3.from_axes((45, 0, 0), (1, 0, 0), (0, 0, 1)))})
    puck = Part.from_mesh("puck", box(16, 16, 16), connectors={"rail": Connector("rail", SE3.from_axes((0, 0, 0), (1, 0, 0), (0, 0, 1)))})
    rail = declare.slider("rail", base["rail"], puck["rail"], limits=(-20.0, 20.0))
    deep = Assembly.from_parts("deep", parts=[base, puck], joints=[rail], ground="base")
    pair = {
        "parts": ["base", "puck"],
        "over": "pose",
        "verdict": "overlap",
        "relation": "mating",
        "depth_mm": 3.0,
        "gap_mm": None,
        "allowed_mm": 0.01,
        "pose": {"rail": -20.0},
        "strength": {"kind": "sampled", "poses": 1},
    }
    checks = deep.check().to_json() | {"pairs": [pair], "findings": []}
    opened = open_page(report_page(deep, Documents(checks=checks)))
    red = "articad.view.overlaps.filter(o => o.solid.visible).length"

    assert opened(red) == 0, "not here"
    opened.page.locator("details.section", has_text="Interference").locator("summary").click()
    opened.page.locator("[data-show]").first.click()

    assert opened(red) == 1
    center = opened("articad.view.overlaps[0].solid.geometry.boundingSphere.center.toArray()")
    assert opened("articad.view.controls.target.toArray()") == pytest.approx(center)
    assert abs(center[0] - 23.5) < 4, "where the puck stands in the base"
    opened("articad.set({ rail: 10 })")
    assert opened(red) == 0
    assert_silent(opened)


def test_a_cut_shows_the_part_that_is_cut_and_not_those_behind_it(open_page: Open) -> None:
    joint = {"side": Connector("side", SE3.from_axes((0, 0, 0), (0, 1, 0), (0, 0, 1)))}
    before = Part.from_mesh("before", box(40, 40, 40), connectors=joint, color="#20b040")
    behind = Part.from_mesh("behind", box(60, 10, 60).transformed(SE3.from_translation([0, 40, 0])), connectors=joint, color="#c03020")
    two = Assembly.from_parts(
        "two", parts=[before, behind], joints=[declare.fixed("side", before["side"], behind["side"])], ground="before"
    )
    opened = open_page(report_page(two), width=900, height=500)
    opened.page.click("[data-view=front]")
    opened.page.locator("#cut-y").evaluate("box => box.click()")
    opened.page.locator("#cut-y-at").evaluate("s => { s.value = 0.3; s.dispatchEvent(new Event('input')) }")
    opened.page.wait_for_function("() => articad.view.settled")

    seen = opened("async () => { const b = await articad.picture(); return Array.from(new Uint8Array(await b.arrayBuffer())) }")
    with Image.open(io.BytesIO(bytes(seen))) as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    middle = pixels[pixels.shape[0] // 2 - 20 : pixels.shape[0] // 2 + 20, pixels.shape[1] // 2 - 20 : pixels.shape[1] // 2 + 20].reshape(
        -1, 3
    )
    assert (middle[:, 1] > middle[:, 0]).all(), "green: the part that is cut"
    assert np.ptp(middle[:, 1]) > 30, "hatched"


@pytest.fixture
def served() -> Iterator[PageServer]:
    with PageServer() as server:
        yield server


def test_the_banner_of_watch_appears_and_goes_and_what_is_seen_survives(chromium: Any, served: PageServer) -> None:
    served.page, served.version = report_page(hinged(), watch="1"), "1"
    context = chromium.new_context(viewport={"width": 1000, "height": 700})
    page = context.new_page()
    page.goto(served.address)
    page.wait_for_selector("html[data-ready]", state="attached")
    page.evaluate("articad.set({ hinge: 0.6 })")
    page.locator("#explode").evaluate("s => { s.value = 0.3; s.dispatchEvent(new Event('input')) }")
    page.click("#tool-names")
    page.click("#theme")
    page.click("[data-view=front]")
    page.locator('[data-visible="2"]').uncheck()
    before = page.evaluate("articad.state()")
    theme = page.evaluate("document.documentElement.dataset.theme")

    served.error = ("1 of 2 parts could not be built.", "parts/lid.py: ValueError: not today. At line 2.")
    page.wait_for_selector("#banner.failed:visible")
    assert page.inner_text("#banner").splitlines()[0] == "1 of 2 parts could not be built."
    assert "line 2" in page.inner_text("#banner")
    served.error = ()
    page.wait_for_selector("#banner", state="hidden")

    served.page, served.version = report_page(hinged(), watch="2"), "2"
    page.wait_for_function("() => window.articad?.model.watch === '2' && document.documentElement.dataset.ready !== undefined")
    assert page.evaluate("articad.state()") == before
    assert page.evaluate("document.documentElement.dataset.theme") == theme
    assert page.get_attribute("#tool-names", "aria-pressed") == "true"

    served.__exit__(None, None, None)
    page.wait_for_selector("#banner.failed:visible")
    assert "has ended" in page.inner_text("#banner")
    context.close()


def test_targets_are_large_and_borders_are_seen(open_page: Open, screen: dict[str, Any]) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly, checked(assembly)), **screen)
    small = opened("""[...document.querySelectorAll('button, input, select, summary')].filter(e => e.offsetParent && (() => {
        const { width, height } = (e.type === 'checkbox' && e.closest('label') || e).getBoundingClientRect();
        return Math.min(width + 6 * (e.type === 'checkbox'), height + 6 * (e.type === 'checkbox')) < 24;
      })()).map(e => e.id || e.outerHTML.slice(0, 80))""")
    assert small == []
    # What a control is known by, its icon or its border, stands out from what is behind it.
    for control, by in (
        ("#reset", "color"),
        ("#tool-names", "color"),
        (".eye", "color"),
        (".value", "borderTopColor"),
        ("#theme", "color"),
    ):
        seen, panel = opened(
            """([control, by]) => [getComputedStyle(document.querySelector(control))[by],
                getComputedStyle(document.querySelector('#panel')).backgroundColor]""",
            [control, by],
        )
        assert contrast(seen, panel) >= 3, control
    assert opened("[...document.querySelectorAll('#tools button')].every(b => b.textContent.trim() || b.ariaLabel)"), "icons have names"
    assert opened("[...document.querySelectorAll('h1, h2')].length") >= 4
    assert "No interference at rest" in opened("document.querySelector('.unseen').textContent")


def test_a_phone_keeps_the_model_above_its_sliders_and_shows_tables_as_cards(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly, checked(assembly)), **SCREENS["phone light"])
    opened("scrollTo(0, 700)")
    frame(opened)

    assert opened("document.querySelector('#stage').getBoundingClientRect().top") == pytest.approx(0, abs=1)
    assert opened("getComputedStyle(document.querySelector('.scroll thead')).display") == "none"
    assert opened("getComputedStyle(document.querySelector('.scroll tr')).display") == "grid"
    label = "getComputedStyle(document.querySelector('.scroll:not(.findings) td[data-label]'), '::before').content"
    assert opened(label).strip('"') == "part"


AXE = Path(os.environ.get("ARTICAD_AXE", ROOT / "articad/report/viewer/node_modules/axe-core/axe.min.js"))


@pytest.mark.skipif(
    not AXE.is_file(), reason="axe-core is missing: npm ci in articad/report/viewer; ./scripts/test viewer does so and runs this test"
)
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("screen_name", ["desktop light", "phone light"])
def test_axe_finds_nothing_serious(open_page: Open, scheme: str, screen_name: str) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly, checked(assembly)), **(SCREENS[screen_name] | {"scheme": scheme}))
    opened("document.querySelectorAll('details').forEach(d => d.open = true)")
    opened.page.mouse.click(*on_screen(opened, "base", [0.0, -20.0, 0.0]))

    assert serious(opened.page) == []


def serious(page: Any) -> list[str]:
    """Return what axe-core calls serious or critical on a page."""
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
    return [
        f"{rule['id']}: {json.dumps(node['target'])} {node['failureSummary']}"
        for rule in found["violations"]
        if rule["impact"] in ("serious", "critical")
        for node in rule["nodes"]
    ]


def test_an_audit_page_shows_the_model_and_each_finding_moves_it(open_page: Open, tmp_path: Path) -> None:
    page = tmp_path / "audit.html"
    assert cli.main(["audit", str(ROOT / "examples" / "hinge.urdf"), "--no-engines", "--report", str(page), "-q"]) == 1
    opened = open_page(page.read_text(encoding="utf-8"))

    assert opened("articad.model.parts.map(p => p.name)") == ["post", "flap"]
    row = opened.page.locator("tr", has_text="E_FLOATING")
    assert "10 mm" in row.inner_text()
    row.locator("[data-show]").click()
    assert opened("[...articad.view.focused]") == [1]
    assert "audit failed" in opened.page.inner_text("header")
    assert_silent(opened)
