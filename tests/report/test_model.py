"""What a page is made of: known answers of its meshes, the same bytes each time, and notebooks."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

from articad.findings import Finding, Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box, cylinder
from articad.interference.report import Checks, PairCheck, Strength
from articad.report import Documents, report_page, viewer_model
from articad.report.drawing import drawn_mesh
from tests.assemblies import all_joint_kinds, four_bar


def decoded(text: str, kind: str) -> np.ndarray[tuple[int], np.dtype[np.generic]]:
    return np.frombuffer(base64.b64decode(text), dtype=kind)


def test_a_box_has_six_faces_and_twelve_edges() -> None:
    drawn = drawn_mesh(box(10, 20, 30))

    assert decoded(drawn["faces"], "<u4").tolist() == [2] * 6
    assert len(decoded(drawn["edges"], "<u2")) == 2 * 12
    assert len(decoded(drawn["triangles"], "<u2")) == 3 * 12
    corners = decoded(drawn["vertices"], "<f4").reshape(-1, 3)
    assert np.ptp(corners, axis=0).tolist() == [10, 20, 30]


def test_a_cylinder_is_smooth_round_and_sharp_at_its_ends() -> None:
    drawn = drawn_mesh(cylinder(5, 8, 48))

    assert len(decoded(drawn["faces"], "<u4")) == 3
    assert len(decoded(drawn["edges"], "<u2")) == 2 * 2 * 48


def test_open_edges_are_drawn_and_an_empty_mesh_is_nothing() -> None:
    one = TriMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]], dtype=np.int32))
    none = TriMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int32))

    assert len(decoded(drawn_mesh(one)["edges"], "<u2")) == 2 * 3
    assert drawn_mesh(none)["triangles"] == ""


def test_equal_meshes_stand_in_the_page_once() -> None:
    model = viewer_model(four_bar())

    assert len(model["meshes"]) == len({mesh["vertices"] for mesh in model["meshes"]})
    assert model["dependent"], "a loop has joints that follow"
    assert [entry["name"] for entry in model["drivers"]] == ["a"]


def test_numbers_are_in_full_and_bounds_that_do_not_exist_are_null() -> None:
    assembly = all_joint_kinds()
    model = json.loads(json.dumps(viewer_model(assembly), allow_nan=False))

    assert model["joints"][0]["parent_frame"] == assembly.joints[0].T_parent_connector.data.tolist()
    wheel = next(column for column in model["coordinates"] if column["name"] == "wheel")
    assert wheel["lower"] is None
    assert next(entry for entry in model["drivers"] if entry.get("name") == "wheel")["endless"]


def test_the_same_assembly_gives_the_same_page_under_another_hash_seed() -> None:
    code = (
        "import hashlib; from articad.report import report_page; from tests.assemblies import all_joint_kinds;"
        "print(hashlib.sha256(report_page(all_joint_kinds()).encode()).hexdigest())"
    )
    here = hashlib.sha256(report_page(all_joint_kinds()).encode()).hexdigest()
    there = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ | {"PYTHONHASHSEED": "5"}
    )

    assert there.stdout.strip() == here


def test_the_policy_names_the_digests_of_what_the_page_holds() -> None:
    text = report_page(four_bar())
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy is not None
    for pattern in (r"<script>(.*?)</script>", r"<style>(.*?)</style>"):
        held = re.findall(pattern, text, re.DOTALL)
        assert len(held) == 1
        assert f"'sha256-{base64.b64encode(hashlib.sha256(held[0].encode()).digest()).decode()}'" in policy[1]
    assert "connect-src 'self'" in report_page(four_bar(), watch="1")


def test_the_page_names_no_address_that_would_be_fetched() -> None:
    text = report_page(four_bar(), Documents(files=["export/urdf/a b.urdf"]))

    assert re.findall(r'\b(?:src|href)="([^"]*)"', text) == ["./export/urdf/a%20b.urdf"]
    named = re.findall(r"url\(([^)]*)", re.findall(r"<style>(.*?)</style>", text, re.DOTALL)[0])
    assert all(address.strip("'\"").startswith("data:image/svg+xml") for address in named), "icons that the page holds itself"


def test_the_conversation_is_summed_up_and_an_unknown_cost_stays_unknown() -> None:
    def reply(step: str, cost: float | None) -> dict[str, object]:
        usage = {"input_tokens": 100, "output_tokens": 20}
        return {
            "step": step,
            "messages": [{"role": "user", "content": [{"type": "text", "text": "A lamp."}]}],
            "reply": {"text": "{}", "cost": cost, "usage": usage},
        }

    known = report_page(four_bar(), Documents(replies=[reply("design/1", 0.25), reply("part/arm/1", 0.5)]))
    unknown = report_page(four_bar(), Documents(replies=[reply("design/1", 0.25), reply("part/arm/1", None)]))

    assert "2 answers, 200 tokens in, 40 out, $0.7500." in known
    assert "2 answers, 200 tokens in, 40 out, cost not known." in unknown


def test_notebooks_show_the_page_in_a_frame_that_can_reach_nothing() -> None:
    bundle = four_bar()._repr_mimebundle_(include=None, exclude=None)

    assert bundle["text/plain"].startswith("<Assembly")
    assert 'sandbox="allow-scripts allow-downloads"' in bundle["text/html"]
    assert "&lt;!doctype html&gt;" in bundle["text/html"]
    assert "<script" not in bundle["text/html"], "all of it is text in srcdoc"


def test_notebooks_show_findings_and_checks_as_escaped_tables() -> None:
    finding = Finding(code="E_OVERLAP", where="parts", message="<b>deep</b>", hint="Cut.", parts=("a", "b"))
    pair = PairCheck(("a<", "b"), "unrelated", "rest", Strength.sampled(1), depth=0.25, verdict="overlap")
    html = Checks(Findings([finding]), (pair,), 0.01)._repr_html_()

    assert "&lt;b&gt;deep&lt;/b&gt;" in html
    assert "a&lt; – b" in html
    assert ">0.25<" in html
    assert Findings()._repr_html_() == "<p>no findings</p>"


@pytest.mark.parametrize("text", ["</script>", "<!--", "<script"])
def test_json_cannot_end_its_element(text: str) -> None:
    page = report_page(four_bar(), Documents(plan=json.dumps({"description": text})))
    plan = re.search(r'<script type="application/json" id="plan">(.*?)</script>', page, re.DOTALL)

    assert plan is not None
    assert json.loads(plan[1]) == {"description": text}
