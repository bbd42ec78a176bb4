"""The page in a browser: what is dragged moves, loops follow, findings are places, nothing is fetched."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.part import Part
from articad.geometry.shapes import box, sphere
from articad.kinematics import declare
from articad.plan.schema import AssemblyPlan
from articad.report import Documents, report_page
from tests.assemblies import all_joint_kinds, four_bar, geared_pair, walker
from tests.moving_bases import excavator, four_bar_on_turntable, gripper_arm
from tests.report.conftest import Opened

ROOT = Path(__file__).resolve().parents[2]
SAME = 1e-9  # mm, and of a rotation matrix: the page's poses against the assembly's
Open = Callable[..., Opened]


def hinged(name: str = "chest", part: str = "lid") -> Assembly:
    """A box with a lid on a hinge, and a slider beside it that stands still when the lid moves."""
    at = {"hinge": Connector("hinge", SE3.from_axes((0, 20, 15), (-1, 0, 0), (0, -1, 0)))}
    lid = {"hinge": Connector("hinge", SE3.from_axes((0, 0, 0), (-1, 0, 0), (0, -1, 0)))}
    rail = Connector("rail", SE3.from_axes((45, 0, 0), (0, 1, 0), (0, 0, 1)))
    base = Part.from_mesh("base", box(60, 40, 28), density=700, connectors=at | {"rail": rail}, color="#b08050", material="oak")
    cover = Part.from_mesh(
        part, box(60, 40, 4).transformed(SE3.from_translation([0, -20, 2])), density=700, connectors=lid, color="#e2c9a0"
    )
    puck = Part.from_mesh(
        "puck",
        sphere(8, 24),
        density=7850,
        connectors={"rail": Connector("rail", SE3.from_axes((0, 0, 0), (0, 1, 0), (0, 0, 1)))},
        color="#3a6ea5",
    )
    joints = [
        declare.revolute("hinge", base["hinge"], cover["hinge"], limits=(0.0, 1.8)),
        declare.slider("rail", base["rail"], puck["rail"], limits=(-20.0, 20.0)),
    ]
    return Assembly.from_parts(name, parts=[base, cover, puck], joints=joints, ground="base")


def example(name: str) -> Assembly:
    folder = ROOT / "examples" / name
    return Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts")


def error_of(opened: Opened, assembly: Assembly, q: NDArray[np.float64]) -> float:
    """Return the largest difference between the matrices that the page draws with and those of the assembly at q."""
    drawn = opened("articad.drawn()")
    T = assembly.poses(q)
    return max(float(np.abs(np.array(drawn[name]) - T[index].matrix).max()) for index, name in enumerate(assembly.mechanism.parts))


def configuration(opened: Opened, assembly: Assembly) -> NDArray[np.float64]:
    """Return the drivers' values as the page says they are."""
    q = opened("articad.q()")
    return np.array([q[driver.name] for driver in assembly.drivers])


def drag(opened: Opened, index: int, share: float) -> None:
    """Drag a slider with the pointer, from where it stands to a share of its length."""
    slider = opened.page.locator("#drivers input[type=range]").nth(index)
    slider.scroll_into_view_if_needed()
    bounds = slider.bounding_box()
    at = slider.evaluate("s => (s.valueAsNumber - s.min) / (s.max - s.min)")
    thumb = 16  # pixels: it travels the rest of the width
    middle = bounds["y"] + bounds["height"] / 2
    opened.page.mouse.move(bounds["x"] + thumb / 2 + at * (bounds["width"] - thumb), middle)
    opened.page.mouse.down()
    opened.page.mouse.move(bounds["x"] + thumb / 2 + share * (bounds["width"] - thumb), middle, steps=4)
    opened.page.mouse.up()


def assert_silent(opened: Opened) -> None:
    """Nothing was said on the console, and nothing was asked for but the page itself."""
    assert opened.console == []
    assert [url for url in opened.requests if not url.startswith(("data:", "blob:"))] == opened.requests[:1]


def test_dragging_each_slider_moves_exactly_its_parts_to_the_poses_of_the_assembly(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly))

    for index, (driver, moved) in enumerate([("hinge", "lid"), ("rail", "puck")]):
        before = opened("articad.drawn()")
        drag(opened, index, 0.8)
        after, q = opened("articad.drawn()"), configuration(opened, assembly)

        assert [name for name in after if after[name] != before[name]] == [moved]
        value = float(q[[d.name for d in assembly.drivers].index(driver)])
        lower, upper = assembly.drivers[index].lower, assembly.drivers[index].upper
        assert abs((value - lower) / (upper - lower) - 0.8) < 0.03, "the thumb went where the pointer went"
        assert error_of(opened, assembly, q) < SAME
    assert_silent(opened)


@pytest.mark.parametrize(
    "make", [all_joint_kinds, walker, geared_pair, four_bar, gripper_arm, four_bar_on_turntable, excavator], ids=lambda make: make.__name__
)
def test_every_kind_of_joint_moves_as_the_assembly_does(open_page: Open, make: Callable[[], Assembly]) -> None:
    assembly = make()
    opened = open_page(report_page(assembly))
    rng = np.random.default_rng(7)

    for _ in range(6):
        values = {}
        for driver in assembly.drivers:
            free = driver if driver.unit == "1" else assembly.feasible_range(driver.name)
            lower, upper = max(free.lower, driver.rest - 3) + 0.01, min(free.upper, driver.rest + 3) - 0.01
            values[driver.name] = float(rng.normal() if driver.unit == "1" else rng.uniform(lower, upper))
        for joint in assembly.joints:
            if joint.type.quaternion is not None:
                names = joint.column_names[joint.type.quaternion :]
                turn = np.array([values[name] for name in names])
                values |= dict(zip(names, (turn / np.linalg.norm(turn)).tolist(), strict=True))
        assert opened("values => articad.set(values)", values)
        q = np.array([values[driver.name] for driver in assembly.drivers])
        assert error_of(opened, assembly, q) < SAME
    assert_silent(opened)


@pytest.mark.parametrize("name", ["scissor_lift", "stewart_platform", "jansen_leg"])
def test_loops_follow_their_drivers_to_the_poses_of_the_assembly(open_page: Open, name: str) -> None:
    assembly = example(name)
    opened = open_page(report_page(assembly))
    rng = np.random.default_rng(3)

    drag(opened, 0, 0.7)
    assert error_of(opened, assembly, configuration(opened, assembly)) < SAME
    for _ in range(4):
        values = {}
        for driver in assembly.drivers:
            free = assembly.feasible_range(driver.name)
            lower, upper = max(free.lower, driver.rest - 4), min(free.upper, driver.rest + 4)
            share = 0.9 if len(assembly.drivers) == 1 else 0.4
            values[driver.name] = float(driver.rest + share * rng.uniform(lower - driver.rest, upper - driver.rest))
        assert opened("values => articad.set(values)", values)
        assert error_of(opened, assembly, np.array([values[driver.name] for driver in assembly.drivers])) < SAME
    moved = opened("articad.q()")
    exact = assembly.mechanism.configuration(configuration(opened, assembly)).columns
    assert [moved[column.name] for column in assembly.mechanism.coordinates] == pytest.approx(exact.tolist(), abs=1e-8)
    assert_silent(opened)


def test_a_dead_point_stops_the_page_where_it_stops_the_assembly(open_page: Open) -> None:
    assembly = example("toggle_clamp")
    opened = open_page(report_page(assembly))
    free = assembly.feasible_range("handle")

    beyond = free.upper + 2.0
    arrived = opened("value => articad.set({handle: value})", beyond)

    q = configuration(opened, assembly)
    assert not arrived
    assert "dead point" in opened.page.inner_text("#status")
    assert q[[d.name for d in assembly.drivers].index("handle")] < beyond
    assert_silent(opened)


def test_a_click_on_a_finding_moves_the_model_there_and_shows_who_is_concerned(open_page: Open) -> None:
    assembly = hinged()
    finding = Finding(
        code="E_MOTION_COLLISION",
        where="joints.hinge",
        message="lid meets puck.",
        hint="Open it less.",
        parts=("lid", "puck"),
        pose={"hinge": 1.25},
    )
    opened = open_page(report_page(assembly, Documents(checks=report_of([finding]))))
    opened("articad.set({hinge: 0.3, rail: 12})")

    opened.page.get_by_role("button", name="Show", exact=True).first.click()

    assert error_of(opened, assembly, assembly.q(hinge=1.25)) < SAME, "the other drivers go to rest: that is where it was found"
    assert opened("articad.view.groups.map(g => [g.name, g.userData.materials[0].opacity < 1])") == [
        ["base", True],
        ["lid", False],
        ["puck", False],
    ]
    assert "hinge = 71.6°" in opened.page.inner_text("#status")
    opened.page.keyboard.press("Escape")
    assert opened("articad.view.focused") is None
    assert_silent(opened)


def report_of(findings: list[Finding]) -> dict[str, Any]:
    return {
        "schema": "articad.checks/1",
        "ok": False,
        "findings": [finding.to_json() for finding in findings],
        "deflection_mm": 0.01,
        "pairs": [],
    }


HOSTILE = "</script><script>document.title='owned'</script><img src=x onerror=\"document.title='owned'\">'\"&"


def test_hostile_words_are_shown_and_never_run(open_page: Open) -> None:
    assembly = hinged(name=HOSTILE, part=HOSTILE)
    finding = Finding(code="E_OVERLAP", where=HOSTILE, message=HOSTILE, hint=HOSTILE, parts=(HOSTILE,), pose={HOSTILE: 1.0})
    reply = {
        "step": HOSTILE,
        "role": "design",
        "messages": [{"role": HOSTILE, "content": HOSTILE}],
        "reply": {"text": HOSTILE, "model": HOSTILE},
    }
    losses = {"ok": True, "main": f"javascript:{HOSTILE}", "rows": [{"where": HOSTILE, "kept": HOSTILE, "lost": HOSTILE}], "findings": []}
    documents = Documents(
        prompt=HOSTILE, checks=report_of([finding]), exports={HOSTILE: losses}, replies=[reply], plan=json.dumps(HOSTILE), files=[HOSTILE]
    )

    opened = open_page(report_page(assembly, documents))
    opened("document.querySelectorAll('details').forEach(d => d.open = true)")
    opened.page.get_by_role("button", name="Show", exact=True).first.click()
    opened.page.keyboard.press("n")

    assert opened.page.title() == f"{HOSTILE} – articad"
    assert opened.page.inner_text("h1") == HOSTILE
    assert opened("articad.view.groups[1].name") == HOSTILE
    assert opened("[...document.querySelectorAll('a')].every(a => a.protocol === 'file:')")
    assert opened("document.images.length") == 0
    assert_silent(opened)


def test_the_page_forbids_itself_everything_but_its_own_script(open_page: Open) -> None:
    opened = open_page(report_page(hinged()))

    policy = opened("document.querySelector('meta[http-equiv]').content")
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert "connect-src" not in policy
    refused = opened("""async () => {
      const told = [];
      document.addEventListener('securitypolicyviolation', event => told.push(event.effectiveDirective));
      await fetch('https://example.invalid/').catch(() => null);
      const script = document.createElement('script');
      script.textContent = 'window.smuggled = 1';
      document.body.append(script);
      await new Promise(done => setTimeout(done, 100));
      return [told.includes('connect-src'), told.includes('script-src-elem'), window.smuggled === undefined];
    }""")
    assert refused == [True, True, True]


def test_everything_can_be_done_from_the_keyboard(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly))
    page = opened.page

    page.locator("#drivers input[type=range]").first.focus()
    before = opened("articad.q().hinge")
    page.keyboard.press("ArrowRight")
    assert opened("articad.q().hinge") > before
    page.locator("#drivers input[type=number]").nth(1).fill("-7.5")
    page.keyboard.press("Enter")
    assert opened("articad.q().rail") == pytest.approx(-7.5)
    page.locator("canvas").focus()
    camera = opened("articad.view.camera.position.toArray()")
    page.keyboard.press("ArrowLeft")
    assert opened("articad.view.camera.position.toArray()") != camera
    for key, state in (("a", "articad.view.axes.visible"), ("m", "document.querySelector('#tool-measure').ariaPressed === 'true'")):
        page.keyboard.press(key)
        assert opened(state)
    page.keyboard.press("r")
    assert opened("articad.q()") == {driver.name: driver.rest for driver in assembly.drivers}
    reachable = opened("[...document.querySelectorAll('button, input, select, summary, canvas')].every(e => e.tabIndex >= 0)")
    named = opened(
        "[...document.querySelectorAll('button, input, select')].filter(e => !(e.textContent.trim() || e.ariaLabel || e.labels?.length)).length"
    )
    assert reachable
    assert named == 0, "every control has a name for those who do not see it"
    assert_silent(opened)


# Parts with a corner of their bounding box outside the canvas.
BEYOND = """() => articad.view.groups.filter(group => {
    const V = articad.view.middle.constructor, { clientWidth: width, clientHeight: height } = articad.view.canvas;
    group.updateMatrixWorld(true);
    return group.children.some(({ geometry, matrixWorld }) => {
        geometry.computeBoundingBox();
        const { min, max } = geometry.boundingBox;
        return [0, 1, 2, 3, 4, 5, 6, 7].some(k => {
            const corner = new V(k & 1 ? min.x : max.x, k & 2 ? min.y : max.y, k & 4 ? min.z : max.z).applyMatrix4(matrixWorld);
            const [x, y] = articad.view.screen(corner);
            return x < 0 || y < 0 || x > width || y > height;
        });
    });
}).map(group => group.name)"""


def test_explode_section_and_measure(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly))
    page = opened.page
    apart = "articad.view.groups[2].matrix.elements[13]"  # along its rail

    before = opened(apart)
    page.locator("#explode").evaluate("s => { s.value = 1; s.dispatchEvent(new Event('input')) }")
    assert opened(apart) > before + 10
    page.locator("#explode").evaluate("s => { s.value = s.max; s.dispatchEvent(new Event('input')) }")
    assert opened(BEYOND) == [], "the camera steps back from what moves apart"
    page.locator("#explode").evaluate("s => { s.value = 0; s.dispatchEvent(new Event('input')) }")
    page.locator("#cut-x").evaluate("box => box.click()")
    assert opened("articad.view.groups[0].userData.materials[0].clippingPlanes.length") == 1
    page.locator("#cut-x").evaluate("box => box.click()")
    page.click("[data-view=top]")
    page.click("#tool-measure")
    corners = opened("""() => { const V = articad.view.middle.constructor, box = articad.view.canvas.getBoundingClientRect();
        return [[-30, -20, 19], [30, -20, 19]].map(p => { const [x, y] = articad.view.screen(new V(...p)); return [box.x + x, box.y + y] }) }""")
    inward = [(3, -3), (-3, -3)]
    for (x, y), (dx, dy) in zip(corners, inward, strict=True):
        page.mouse.click(x + dx, y + dy)
    assert page.inner_text("#measured").startswith("lid – lid: 60.000 mm"), "corners are caught"
    assert_silent(opened)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_on_a_phone(open_page: Open, scheme: str) -> None:
    opened = open_page(report_page(hinged()), width=390, height=800, scheme=scheme, phone=True)

    assert opened("document.documentElement.scrollWidth") <= 390
    assert opened("Math.min(...[...document.querySelectorAll('#tools button:not([hidden])')].map(b => b.offsetHeight))") >= 36
    ink, paper = opened("[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]")
    assert contrast(ink, paper) > 7
    opened.page.locator("#drivers input[type=range]").first.evaluate("s => { s.value = 40; s.dispatchEvent(new Event('input')) }")
    assert opened("articad.q().hinge") == pytest.approx(math.radians(40))
    assert_silent(opened)


def contrast(a: str, b: str) -> float:
    """Return the ratio of two colours' luminances, as WCAG has it."""

    def luminance(color: str) -> float:
        channels = [int(number) / 255 for number in color[color.index("(") + 1 : -1].split(",")[:3]]
        linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))

    high, low = sorted([luminance(a), luminance(b)], reverse=True)
    return (high + 0.05) / (low + 0.05)


KEPT = ROOT / "docs" / "images" / "report.png"
FEW = 0.02  # of all pixels may differ visibly from the kept picture: fonts and another Chromium smooth edges otherwise
VISIBLY = 48  # of 255, in any channel


def test_it_looks_as_it_does_in_the_documentation(open_page: Open) -> None:
    opened = open_page(showcase(), width=1200, height=760)
    opened.page.wait_for_function("() => articad.view.settled")
    seen = np.asarray(Image.open(io.BytesIO(opened.page.screenshot())).convert("RGB")).astype(int)
    kept = np.asarray(Image.open(KEPT).convert("RGB")).astype(int)

    assert seen.shape == kept.shape
    model = np.abs(seen - kept)[60:, :720].max(axis=-1) > VISIBLY  # left of the panel, whose text depends on the system's fonts
    assert model.mean() < FEW, "run scripts/screenshot.py and look at docs/images/report.png"


def showcase() -> str:
    """Return the page whose picture is in the documentation."""
    assembly = example("desk_lamp")
    return report_page(assembly, Documents(checks=assembly.check().to_json()))


def test_least_clearances_and_followers_stand_in_degrees_and_mm(open_page: Open) -> None:
    assembly = four_bar()
    names = assembly.mechanism.parts[:2]
    driver = assembly.drivers[0].name
    clearance = {"parts": list(names), "relation": "unrelated", "gap_mm": 1.25, "pose": {driver: math.pi / 6}, "strength": {"poses": 40}}
    table = {"driver": driver, "values": [0.0, math.pi / 2], "followers": {"other": [0.0, -3.5]}, "units": {driver: "rad", "other": "mm"}}
    certificate = {
        "ok": True,
        "covers": "all.",
        "epsilon_mm": 1e-3,
        "pairs": [],
        "clearances": [clearance],
        "follows": [table],
        "findings": [],
    }
    opened = open_page(report_page(assembly, Documents(certificate=certificate)))
    text = "s => [...document.querySelectorAll('details.section')].find(d => d.querySelector('summary').textContent === s).textContent"
    clearances, follows = (opened(text, title) for title in ("Least clearances over the motion", "Joints that follow the drivers"))
    assert f"{driver} = 30.00°" in clearances
    assert "1.25" in clearances
    assert f"{driver} °other mm" in follows
    assert "90.00-3.50" in follows
    opened.page.evaluate("document.querySelectorAll('details.section').forEach(d => { d.open = true })")
    opened.page.locator("details.section", has_text="Least clearances").locator("button[data-show]").first.click()
    assert configuration(opened, assembly)[0] == pytest.approx(math.pi / 6)
    assert_silent(opened)


def on_screen(opened: Opened, part: str, local: list[float]) -> tuple[float, float]:
    """Return where a point of a part is drawn, in pixels of the page, from the matrices of the picture."""
    x, y = opened(
        """([part, local]) => {
          const { view } = articad, group = view.groups.find((entry) => entry.name === part);
          group.updateMatrixWorld(true);
          const e = group.matrixWorld.elements, p = [0, 1, 2].map((row) => e[row] * local[0] + e[row + 4] * local[1] + e[row + 8] * local[2] + e[row + 12]);
          const clip = view.camera.position.clone().set(...p).project(view.camera), box = view.canvas.getBoundingClientRect();
          return [box.left + (clip.x + 1) / 2 * box.width, box.top + (1 - clip.y) / 2 * box.height];
        }""",
        [part, local],
    )
    return float(x), float(y)


def pulled(opened: Opened, start: tuple[float, float], end: tuple[float, float]) -> None:
    opened.page.mouse.move(*start)
    opened.page.mouse.down()
    opened.page.mouse.move(*end, steps=5)
    opened.page.mouse.up()


def test_a_part_that_is_dragged_moves_its_joint_to_the_pointer_and_feels_the_limit(open_page: Open) -> None:
    assembly = hinged()
    opened = open_page(report_page(assembly))
    corner = [20.0, -36.0, 4.0]  # on top of the lid, near its front edge
    start = on_screen(opened, "lid", corner)
    opened("articad.set({ hinge: 0.9 })")
    end = on_screen(opened, "lid", corner)
    opened("articad.set({ hinge: 0 })")
    camera = opened("articad.view.camera.position.toArray()")

    pulled(opened, start, end)

    q = opened("articad.q()")
    assert q["hinge"] == pytest.approx(0.9, abs=0.02)
    assert q["rail"] == 0
    assert math.dist(on_screen(opened, "lid", corner), end) < 2
    assert error_of(opened, assembly, configuration(opened, assembly)) < SAME
    assert opened("articad.view.camera.position.toArray()") == camera, "the camera stays"
    pulled(opened, on_screen(opened, "lid", corner), (end[0] + 300, end[1] - 350))
    pulled(opened, on_screen(opened, "lid", corner), (end[0] + 300, end[1] - 350))
    assert 0.9 < opened("articad.q()")["hinge"] <= 1.8
    assert_silent(opened)


# The visible point of a part that a driver moves farthest, in the part's frame.
FARTHEST = """([part, driver]) => {
  const { view, model } = articad, index = model.parts.findIndex((entry) => entry.name === part), box = view.canvas.getBoundingClientRect();
  const hits = [];
  for (let x = 4; x < box.width; x += 8) for (let y = 4; y < box.height; y += 8) {
    const hit = document.elementFromPoint(box.left + x, box.top + y) === view.canvas && view.pick(box.left + x, box.top + y, { exact: true });
    if (hit?.part === index) hits.push([hit.local, view.screen(view.worldOf(hit))]);
  }
  const value = articad.q()[driver];
  articad.set({ [driver]: value + 0.2 });
  const moved = ([local, [x, y]]) => { const [u, v] = view.screen(view.worldOf({ part: index, local })); return Math.hypot(u - x, v - y); };
  const best = hits.map((hit) => [moved(hit), hit]).sort((a, b) => b[0] - a[0])[0];
  articad.reset();
  return best[1][0].toArray();
}"""


def test_a_dragged_crank_takes_its_loop_with_it(open_page: Open) -> None:
    assembly = four_bar()
    opened = open_page(report_page(assembly))
    name, driver = assembly.mechanism.driving_joints[0], assembly.drivers[0]
    joint = next(entry for entry in assembly.joints if entry.name == name)
    axis = np.abs(np.asarray(joint.T_parent_connector.z_axis)).argmax()
    opened(
        "(view) => { articad.view.look(view); articad.view.draw(); articad.view.scene.updateMatrixWorld(true) }",
        ("right", "front", "top")[axis],
    )
    point = opened(FARTHEST, [joint.child, driver.name])
    start = on_screen(opened, joint.child, point)
    opened("([name, value]) => articad.set({ [name]: value })", [driver.name, driver.rest + 0.3])
    end = on_screen(opened, joint.child, point)
    opened("articad.reset()")

    pulled(opened, start, end)

    assert opened("articad.q()")[driver.name] == pytest.approx(driver.rest + 0.3, abs=0.1)
    assert error_of(opened, assembly, configuration(opened, assembly)) < SAME


def test_a_part_lights_up_under_the_pointer_and_a_click_selects_it_in_the_table(open_page: Open) -> None:
    opened = open_page(report_page(hinged()))
    at = on_screen(opened, "base", [0.0, -20.0, 0.0])

    opened.page.mouse.move(*at)
    opened("new Promise((done) => requestAnimationFrame(() => done()))")
    assert opened("articad.view.groups.map(g => g.userData.materials[0].emissive.getHex() > 0)") == [True, False, False]
    opened.page.mouse.click(*at)

    card = opened.page.inner_text("#card")
    assert all(words in card for words in ("base", "oak", "hinge (revolute), rail (slider)"))
    assert opened("[...document.querySelectorAll('tr.selected')].map(row => row.querySelector('[data-part]').textContent)") == ["base"]
    opened.page.mouse.click(*at)
    assert opened("document.querySelectorAll('tr.selected').length") == 0
    assert opened("[...document.querySelectorAll('.limits')].map(each => each.textContent)") == ["0.0° … 103.1°", "-20.0 mm … 20.0 mm"]
