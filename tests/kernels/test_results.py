"""Nothing that a script's process left is believed: every poisoned result is refused before it is used."""

from __future__ import annotations

import io
import json
import pickle
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.errors import BuildError, ContractError
from articad.geometry.shapes import box
from articad.kernels.archive import packed
from articad.kernels.build123d import Build123dKernel
from articad.kernels.contract import TOLD_EXTRAS
from articad.kernels.freecad import harmless
from articad.kernels.freecad_file import rounded, shortened
from articad.kernels.results import REPORT_BYTES, PoisonedError, numbers, read_lines, read_mesh
from articad.kernels.zygote import JobOutcome

CUBE = box(1, 1, 1)
V, T, F = CUBE.vertices, CUBE.triangles, np.zeros(len(CUBE.triangles), np.int32)


def npz(**arrays: Any) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **{"vertices": V, "triangles": T, "face": F, **arrays})
    return stream.getvalue()


def with_header(claim: str, content: bytes = b"") -> bytes:
    """A .npz whose triangles claim a shape of their own."""
    header = f"{{'descr': '<i4', 'fortran_order': False, 'shape': {claim}, }}".ljust(117) + "\n"
    array = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header.encode() + content
    stream = io.BytesIO(npz())
    parts = {}
    with zipfile.ZipFile(stream) as archive:
        for name in archive.namelist():
            parts[name] = archive.read(name)
    parts["triangles.npy"] = array
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return stream.getvalue()


def deflated() -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(stream, vertices=np.zeros((10**6, 3)), triangles=T, face=F)
    return stream.getvalue()


def spoiled(array: Any, index: tuple[int, int], value: float) -> Any:
    copy = np.array(array)
    copy[index] = value
    return copy


def test_an_honest_mesh_is_read() -> None:
    mesh = read_mesh(npz())

    assert mesh.digest == CUBE.digest
    assert mesh.face is not None


POISONED: dict[str, Callable[[], bytes]] = {
    "empty": lambda: b"",
    "no zip": lambda: b"x" * 1000,
    "torn": lambda: npz()[: len(npz()) // 2],
    "pickle": lambda: npz(face=np.array([{}] * 12, dtype=object)),
    "raw pickle": lambda: pickle.dumps({"vertices": V}),
    "NaN": lambda: npz(vertices=spoiled(V, (0, 0), np.nan)),
    "infinity": lambda: npz(vertices=spoiled(V, (0, 0), np.inf)),
    "ten billion millimetres": lambda: npz(vertices=spoiled(V, (0, 0), 1e13)),
    "index too large": lambda: npz(triangles=spoiled(T, (0, 0), 8)),
    "negative index": lambda: npz(triangles=spoiled(T, (0, 0), -1)),
    "negative face": lambda: npz(face=F - 1),
    "too few faces": lambda: npz(face=F[:3]),
    "a billion triangles": lambda: with_header("(1000000000, 3)"),
    "a trillion triangles": lambda: with_header("(1000000000000, 3)"),
    "negative shape": lambda: with_header("(-1, 3)"),
    "no tuple": lambda: with_header("'x'"),
    "code in the header": lambda: with_header("__import__('os').system('true')"),
    "floats as indices": lambda: npz(triangles=T.astype(float)),
    "wrong rank": lambda: npz(vertices=V.ravel()),
    "four columns": lambda: npz(vertices=np.zeros((8, 4))),
    "fortran order": lambda: npz(vertices=np.asfortranarray(np.arange(24.0).reshape(8, 3))),
    "one array more": lambda: npz(extra=np.zeros(3)),
    "compressed": deflated,
}


@pytest.mark.parametrize("kind", POISONED)
def test_a_poisoned_mesh_is_refused(kind: str) -> None:
    with pytest.raises(PoisonedError):
        read_mesh(POISONED[kind]())


@pytest.mark.parametrize(
    "content",
    [
        b"no json\n",
        b'{"a": NaN}\n',
        b'{"a": Infinity}\n',
        b"[1]\n",
        b"[" * 100000 + b"\n",
        b'"text"\n',
        b"\xff\xfe\n",
        b" " * (REPORT_BYTES + 1),
    ],
)
def test_a_poisoned_report_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "report"
    path.write_bytes(content)

    with pytest.raises(PoisonedError):
        read_lines(path)


def test_an_unfinished_line_of_a_report_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "report"
    path.write_bytes(b'{"ok": true}\n{"probe": {"dim')

    assert read_lines(path) == [{"ok": True}]


@pytest.mark.parametrize(
    "value", [None, "x", [1, 2], [1, 2, "3x"], [1, 2, None], [1, 2, float("nan")], [1, 2, 1e400], [[1, 2, 3]], {}, [1, 2, {}]]
)
def test_what_is_not_three_numbers_is_refused(value: Any) -> None:
    with pytest.raises(PoisonedError):
        numbers(value, 3)


MEASURED = {
    "ok": True,
    "solids": 1,
    "loose": 0,
    "valid": True,
    "closed": True,
    "volume_mm3": 1.0,
    "area_mm2": 6.0,
    "com_mm": [0, 0, 0],
    "inertia_mm5": [[1 / 6, 0, 0], [0, 1 / 6, 0], [0, 0, 1 / 6]],
    "bbox_mm": [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]],
}


class ForgingKernel(Build123dKernel):
    """A kernel whose confined processes leave what the test says."""

    def __init__(self, script_report: list[Any], measured: dict[str, Any], files: dict[str, bytes]) -> None:
        super().__init__()
        self.reports = {"script": script_report, "measure": [measured], "judge": [measured], "pieces": []}
        self.files = files

    def _run(self, task: str, job: Path, *_: Any) -> Any:
        from articad.kernels.build123d import _Ran

        for name, content in self.files.items():
            (job / name).write_bytes(content)
        path = job / "forged"
        path.write_text("".join(json.dumps(line) + "\n" for line in self.reports[task]))
        return _Ran(JobOutcome(0, 0, late=False, peak=0), read_lines(path), "")


HONEST_FILES = {"part.npz": npz(), "part.brep": b"\nCASCADE Topology V1\n", "part.step": b"ISO-10303-21;\n", "shape.bin": b""}


def test_the_forging_kernel_passes_when_it_is_honest(brief: dict[str, Any]) -> None:
    kernel = ForgingKernel([{"ok": True, "connectors": {}}], MEASURED, HONEST_FILES)

    assert kernel.build(b"", brief).solid.volume == 1.0


@pytest.mark.parametrize(
    ("script", "measured", "files"),
    [
        ([{"ok": True}], {}, {}),
        ([{"ok": True, "connectors": []}], {}, {}),
        ([{"ok": True, "connectors": {"a": 3}}], {}, {}),
        ([{"ok": True, "connectors": {"a": {"o": [0, 0], "z": None}}}], {}, {}),
        ([{"ok": True, "connectors": {}}, {"probe": {"dimension": "not there", "outcome": "unused"}}], {}, {}),
        ([{"ok": True, "connectors": {}}, *[{"probe": {"dimension": "size", "outcome": "unused"}}] * 2], {}, {}),
        (None, {"volume_mm3": 2.0}, {}),
        (None, {"volume_mm3": None}, {}),
        (None, {"volume_mm3": "1"}, {}),
        (None, {"solids": True}, {}),
        (None, {"com_mm": [0, 0]}, {}),
        (None, {"bbox_mm": "x"}, {}),
        (None, {"inertia_mm5": [[1]]}, {}),
        (None, {"inertia_mm5": [[9, 0, 0], [0, 9, 0], [0, 0, 9]]}, {}),
        (None, {"com_mm": [3, 0, 0]}, {}),
        (None, {"bbox_mm": [[0, 0, 0], [1, 1, 2]]}, {}),
        (None, {}, {"part.npz": npz(triangles=T[:-1], face=F[:-1])}),
        (None, {}, {"part.npz": npz(triangles=T[:, ::-1])}),
        (None, {}, {"part.step": b"MZ\x90"}),
        (None, {}, {"part.brep": b"#!/bin/sh"}),
    ],
)
def test_forged_results_are_refused(brief: dict[str, Any], script: Any, measured: dict[str, Any], files: dict[str, bytes]) -> None:
    connectors = {"a": {"o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "", "joints": []}} if script else {}
    kernel = ForgingKernel(script or [{"ok": True, "connectors": {}}], MEASURED | measured, HONEST_FILES | files)

    with pytest.raises(BuildError) as caught:
        kernel.build(b"", {**brief, "connectors": connectors, "dimensions": {"size": 1.0}})

    assert caught.value.findings.codes == ("E_SCRIPT_FORBIDDEN",)


def test_connectors_without_end_are_told_in_few_words(brief: dict[str, Any]) -> None:
    """Each would be a finding for the model to mend, and thousands of them its whole budget."""
    frame = {"o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0]}
    reported = {f"more_{number}": frame for number in range(5000)} | {"/home/me/\x1b" + "x" * 10**5: frame}
    kernel = ForgingKernel([{"ok": True, "connectors": dict(reversed(reported.items()))}], MEASURED, HONEST_FILES)

    with pytest.raises(ContractError) as caught:
        kernel.build(b"", brief)

    told = [finding for finding in caught.value.findings if finding.code == "E_CONNECTOR_EXTRA"]
    assert len(told) == TOLD_EXTRAS + 1
    assert "4981 more connectors" in str(caught.value)
    assert len(str(caught.value)) < 4000


def document(inner: str) -> bytes:
    return packed({"Document.xml": f"<Document><Objects/><ObjectData>{inner}</ObjectData></Document>".encode()})


@pytest.mark.parametrize(
    ("inner", "what"),
    [
        ('<Cell address="A1" content="=_py"/>', "an expression that reaches out"),
        ('<Cell address="A1" content=" =_re"/>', "an expression that reaches out"),
        ('<Cell address="A1" content="=href(A2)"/>', "an expression that reaches out"),
        ('<Cell address="A1" content="=other#Box.Length"/>', "an expression that reaches out"),
        ('<Expression path="Length" expression="_py.open"/>', "an expression that reaches out"),
        ('<Property type="App::PropertyPythonObject"><Python module="os" class="x"/></Property>', "Python objects"),
        ('<XLink file="/etc/passwd" name="a"/>', "links to other files"),
        ('<Part file="../../a.brp"/>', "a file named"),
        ('<Cell address="A1" content="=_gui.ActiveDocument"/>', "an expression that reaches out"),
        ('<a:XLink xmlns:a="b" file="/etc/passwd.txt" name="a"/>', "names of another vocabulary"),
        ('<a:Object xmlns:a="b" type="Mesh::Import" name="a"/>', "names of another vocabulary"),
        ('<Object xmlns="b" type="Mesh::Import" name="a"/>', "names of another vocabulary"),
        ('<Property name="a" type="antigravity::X"/>', "something of type antigravity::X"),
        ('<_Property name="a" type="antigravity::X"/>', "something of type antigravity::X"),
        ('<Extension name="a" type="antigravity::Extension"/>', "something of type antigravity::Extension"),
        ('<Geometry type="Part::Feature"/>', "something of type Part::Feature"),
        ('<GeoExtension type="Part::GeomCircle"/>', "something of type Part::GeomCircle"),
        ('<Novelty type="antigravity::X"/>', "something of type antigravity::X"),
        ('<Object type="Part::Feature" name="a" ViewType="antigravity::X"/>', "a view of its own"),
    ],
)
def test_a_document_that_would_do_something_when_it_is_opened_is_refused(inner: str, what: str) -> None:
    with pytest.raises(PoisonedError, match=what):
        harmless(document(inner))


@pytest.mark.parametrize(
    "inner",
    [
        '<Cell address="A1" content="=1 + B2"/>',
        '<Cell address="A1" content="bolt #4, see href"/>',
        '<A expression="Dimensions.d_a * 1 mm"/>',
        '<Property name="Shape" type="Part::PropertyPartShape"/><_Property name="Tip" type="App::PropertyLink"/>',
        '<Extension type="Part::AttachExtension"/><Geometry type="Part::GeomCircle"/><Constrain Type="5"/>',
        '<GeoExtension type="Sketcher::SketchGeometryExtension" internalGeometryType="0"/>',
    ],
)
def test_a_document_of_features_is_kept(inner: str) -> None:
    assert harmless(document(inner)) == document(inner)


@pytest.mark.parametrize(
    "head", ['<?xml version="1.1"?>', '<?xml version="1.0" encoding="iso-8859-1"?>', '<?xml version="1.0" encoding="utf-16"?>']
)
def test_a_document_that_two_readers_may_spell_differently_is_refused(head: str) -> None:
    text = f"{head}<Document><Objects/><ObjectData/></Document>".encode("utf-16" if "utf-16" in head else "utf-8")

    with pytest.raises(PoisonedError, match="another spelling"):
        harmless(packed({"Document.xml": text}))


@pytest.mark.parametrize("reader", [rounded, shortened])
@pytest.mark.parametrize("text", [b"1" * 2**16, b"1" * 2**16 + b".", b"-1." * 2**15, b"0." + b"1" * 12 + b"-" * 2**16])
def test_a_number_without_end_takes_no_time_without_end(reader: Callable[[bytes], bytes], text: bytes) -> None:
    """Each took minutes when it was looked at from every digit on, and hours for the megabytes that a script may leave."""
    started = time.process_time()
    assert reader(text) == text

    assert time.process_time() - started < 5.0
