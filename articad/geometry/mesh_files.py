"""Mesh files: STL, OBJ, GLB and PLY, read and written; COLLADA (DAE), read.

STL and OBJ are read with NumPy, and so is everything written; trimesh is loaded only to read GLB, PLY and DAE.
The unit that a DAE states is applied. Its up axis is ignored, as is glTF's convention that y points up: readers of URDF take coordinates
as they are (Pinocchio, and trimesh under yourdfpy).
What is written depends on the mesh alone: no times, no names of programs, no order of dictionaries.
A file is somebody else's: whatever is wrong with it becomes a `ReadError` that says where.
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import re
import struct
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

from articad.arrays import FloatArray
from articad.errors import ArticadError, ReadError
from articad.files import is_file, read_file
from articad.findings import Finding
from articad.geometry.mesh import TriMesh, merged

MAX_FILE_BYTES = 128 << 20  # binary STL of MAX_TRIANGLES has 50 MB
MAX_TRIANGLES = 1_000_000  # of one file, placed copies included; MuJoCo takes 200,000
MAX_WORDS = 8_000_000  # of a text format: 380,000 triangles of a text STL, a million of an OBJ with half a million vertices
MAX_DAE_WORDS = 16_000_000  # of a DAE: a million triangles whose corners have a normal and a place in a texture each
MAX_NODES = 10_000  # placed shapes of a scene
MAX_LIBRARIES = 100  # of materials, that an OBJ names and that are looked for
MAX_MARKS = 2_000_000  # brackets and commas of the JSON in a glTF, tags of a DAE
STL_HEADER = b"articad binary STL, mm".ljust(80, b" ")  # must not begin with "solid", or readers take it for text
_OBJ_HEADER = b"# articad, mm\n"
MADE_BY_ARTICAD = (STL_HEADER, _OBJ_HEADER)  # beginnings of the meshes that articad writes
_STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_STL_KEYWORDS = {
    0: b"facet",
    1: b"normal",
    5: b"outer",
    6: b"loop",
    7: b"vertex",
    11: b"vertex",
    15: b"vertex",
    19: b"endloop",
    20: b"endfacet",
}
_STL_NUMBERS = (8, 9, 10, 12, 13, 14, 16, 17, 18)
_STL_TOKENS = 21  # facet normal n n n outer loop (vertex x y z) x 3 endloop endfacet


def read_mesh(path: str | Path, scale: float = 1.0, root: Path | None = None) -> TriMesh:
    """Read a mesh file; exactly equal vertices are merged, collapsed triangles dropped.

    Args:
        path: A file whose name ends in .stl, .obj, .glb, .gltf, .ply or .dae.
        scale: Millimetres per unit of the file; a DAE counts as one in metres, whatever unit it states.
        root: A folder above the file; no component below it may be a link.

    Raises:
        ReadError: If the file is missing, too large, malformed, truncated or contains no triangle.
    """
    path = Path(path)
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise _unreadable(path, "name", f"extension {path.suffix!r} is not one of {', '.join(_READERS)}")
    try:
        content = read_file(path, MAX_FILE_BYTES, root=root)
    except OSError as error:
        raise _unreadable(path, "file", error.strerror or str(error)) from error
    mesh = _checked(path, lambda: reader(path, content))
    if not len(mesh.triangles):
        raise _unreadable(path, "file", "it holds no triangle")
    return mesh if scale == 1.0 else mesh.scaled(scale)


def states_colors(path: Path, root: Path | None = None) -> bool:
    """Return whether a mesh file states colours or textures of its own; `read_mesh` reads shapes only.

    Args:
        path: A file that `read_mesh` reads.
        root: As for `read_mesh`; an OBJ's materials are looked for there.
    """
    content = read_file(path, MAX_FILE_BYTES, root=root)
    match path.suffix.lower():
        case ".obj":
            names = dict.fromkeys(_MTLLIB.findall(content)) if b"usemtl " in content else {}
            places = [path.parent / name.decode(errors="replace").strip() for name in islice(names, MAX_LIBRARIES)]
            return any(is_file(place, root=root or path.parent) for place in places)
        case ".dae":
            return b"<instance_material" in content
        case ".glb" | ".gltf":
            return b'"materials"' in content
        case ".ply":
            return re.search(rb"^property \w+ (?:diffuse_)?red\s*$", content.partition(b"end_header")[0], re.MULTILINE) is not None
    return False


def write_stl(mesh: TriMesh) -> bytes:
    """Return the mesh as binary STL, float32, in the mesh's unit."""
    corners = mesh.vertices[mesh.triangles]
    u, v = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    normal = np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
    length = np.sqrt((normal * normal).sum(axis=0))
    length[length == 0] = 1.0  # a degenerate triangle has no normal, which zeros state
    numbers = np.empty((len(corners), 12), dtype="<f4")
    numbers[:, :3] = (normal / length).T
    numbers[:, 3:] = corners.reshape(-1, 9)
    records = np.zeros((len(corners), _STL_RECORD.itemsize), dtype=np.uint8)
    records[:, : 4 * 12] = numbers.view(np.uint8)
    return STL_HEADER + struct.pack("<I", len(records)) + records.tobytes()


def write_obj(mesh: TriMesh) -> bytes:
    """Return the mesh as OBJ text with nine significant digits: a micrometre at a kilometre."""
    vertices = ("v %.9g %.9g %.9g\n" * len(mesh.vertices)) % tuple((mesh.vertices + 0.0).ravel().tolist())
    return b"".join((_OBJ_HEADER, vertices.encode("ascii"), _obj_triangles(mesh)))


def _obj_triangles(mesh: TriMesh) -> bytes:
    """Return the lines "f a b c". Each vertex's text is made once, padded to one length with zero bytes that are removed at the end."""
    number = np.arange(1, len(mesh.vertices) + 1)
    digits = len(str(len(mesh.vertices)))
    words = np.zeros((len(number), 1 + digits), dtype=np.uint8)
    words[:, 0] = ord(" ")
    for column in range(1, 1 + digits):
        place = 10 ** (digits - column)
        words[place - 1 :, column] = number[place - 1 :] // place % 10 + ord("0")
    lines = np.empty(len(mesh.triangles), dtype=[("f", "S1"), ("words", np.dtype((np.void, 1 + digits)), 3), ("end", "S1")])
    lines["f"], lines["end"] = b"f", b"\n"
    lines["words"] = words.view(lines.dtype["words"].base)[:, 0][mesh.triangles]
    return lines.tobytes().translate(None, b"\0")


def write_ply(mesh: TriMesh) -> bytes:
    """Return the mesh as binary little-endian PLY with float64 vertices."""
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment articad, mm\n"
        f"element vertex {len(mesh.vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(mesh.triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = mesh.triangles
    return header.encode("ascii") + mesh.vertices.astype("<f8", copy=False).tobytes() + faces.tobytes()


def write_glb(mesh: TriMesh, color: str | None = None) -> bytes:
    """Return the mesh as a GLB with one node, in the mesh's unit and axes.

    Args:
        mesh: The mesh; float32 in the file.
        color: "#rrggbb" of the surface.
    """
    positions = mesh.vertices.astype("<f4")
    indices = mesh.triangles.astype("<u4")
    low, high = (positions.min(axis=0), positions.max(axis=0)) if len(positions) else (np.zeros(3), np.zeros(3))
    primitive: dict[str, object] = {"attributes": {"POSITION": 0}, "indices": 1}
    document: dict[str, object] = {
        "asset": {"version": "2.0", "generator": "articad"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3", "min": low.tolist(), "max": high.tolist()},
            {"bufferView": 1, "componentType": 5125, "count": indices.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": positions.nbytes, "target": 34962},
            {"buffer": 0, "byteOffset": positions.nbytes, "byteLength": indices.nbytes, "target": 34963},
        ],
        "buffers": [{"byteLength": positions.nbytes + indices.nbytes}],
    }
    if color is not None:
        primitive["material"] = 0
        document["materials"] = [
            {"pbrMetallicRoughness": {"baseColorFactor": [*linear_color(color), 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}}
        ]
    return packed_glb(document, positions.tobytes() + indices.tobytes())


def packed_glb(document: dict[str, Any], binary: bytes) -> bytes:
    """Return a GLB: a header, the document of glTF as JSON, and its one buffer if it has one (glTF 2.0, chapter 4)."""
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def linear_color(color: str) -> list[float]:
    """Convert "#rrggbb" (sRGB) to the linear factors of glTF."""
    channels = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]


def _read_stl(path: Path, content: bytes) -> TriMesh:
    if len(content) >= 84:
        count = struct.unpack_from("<I", content, 80)[0]
        if len(content) == 84 + count * _STL_RECORD.itemsize:
            _require_few(path, count, MAX_TRIANGLES, "triangles")
            records = np.frombuffer(content, dtype=_STL_RECORD, offset=84)
            return _soup(path, records["corners"].reshape(-1, 3).astype(np.float64))
    if content[:256].lstrip()[:5].lower() == b"solid" and b"\0" not in content[:1024]:
        return _read_text_stl(path, content)
    if len(content) < 84:
        raise _unreadable(path, f"byte {len(content)}", "a binary STL has at least 84 bytes")
    have, odd = divmod(len(content) - 84, _STL_RECORD.itemsize)
    raise _unreadable(
        path, f"byte {len(content)}", f"its header announces {count} triangles, but {have} and {odd} bytes follow; is it truncated?"
    )


def _read_text_stl(path: Path, content: bytes) -> TriMesh:
    _require_few(path, _words(content), MAX_WORDS, "words")
    lines = [line for line in content.splitlines() if line.lstrip()[:5].lower() != b"solid" and line.lstrip()[:8].lower() != b"endsolid"]
    tokens = b"\n".join(lines).split()
    well_formed = len(tokens) % _STL_TOKENS == 0
    if well_formed:
        well_formed = all(token.lower() == word for at, word in _STL_KEYWORDS.items() for token in tokens[at::_STL_TOKENS])
    if not well_formed:
        raise _unreadable(
            path, _place_in_text_stl(content), "not a facet of the form 'facet normal … outer loop, 3 vertices, endloop endfacet'"
        )
    table = np.empty((len(tokens) // _STL_TOKENS, 9))
    for column, at in enumerate(_STL_NUMBERS):
        try:
            table[:, column] = tokens[at::_STL_TOKENS]
        except ValueError as error:
            raise _unreadable(path, _place_in_text_stl(content), str(error)) from error
    return _soup(path, table.reshape(-1, 3))


def _place_in_text_stl(content: bytes) -> str:
    """Find the first line that does not follow from the one before."""
    expected = [(b"facet", 5), (b"outer", 2), (b"vertex", 4), (b"vertex", 4), (b"vertex", 4), (b"endloop", 1), (b"endfacet", 1)]
    at = 0
    number = 0
    for number, line in enumerate(content.splitlines(), 1):
        words = line.split()
        if not words or words[0].lower() in (b"solid", b"endsolid"):
            continue
        keyword, count = expected[at]
        if words[0].lower() != keyword or len(words) != count or (keyword in (b"facet", b"vertex") and not _are_numbers(words[-3:])):
            return f"line {number}"
        at = (at + 1) % len(expected)
    return f"end of file, after line {number}"


def _are_numbers(words: list[bytes]) -> bool:
    try:
        return bool(np.isfinite([float(word) for word in words]).all())
    except ValueError:
        return False


def _soup(path: Path, corners: FloatArray) -> TriMesh:
    bad = ~np.isfinite(corners).all(axis=1)
    if bad.any():
        raise _unreadable(path, f"triangle {int(np.flatnonzero(bad)[0]) // 3}", "a coordinate is not a finite number")
    return TriMesh(corners, np.arange(len(corners), dtype=np.int32).reshape(-1, 3)).welded()


def _read_obj(path: Path, content: bytes) -> TriMesh:
    content = content.replace(b"\r\n", b"\n").replace(b"\\\n", b" ")
    _require_few(path, _words(content), MAX_WORDS, "words")
    lines = _OBJ_LINE.findall(content)
    vertices = _obj_vertices(path, content, b"\n".join(line[2:] for line in lines if line.startswith(b"v")))
    triangles = _obj_triangles_at_once(b"\n".join(line[2:] for line in lines if line.startswith(b"f")))
    if triangles is None or (len(triangles) and (triangles.min() < 0 or triangles.max() >= len(vertices))):
        triangles = _obj_faces_one_by_one(path, content, len(vertices))
    return TriMesh(vertices, triangles.astype(np.int32)).welded()


_OBJ_LINE = re.compile(rb"^[vf][ \t][^\n]*", re.MULTILINE)
"""A line of an OBJ that states a vertex or a face; all others are ignored."""


_MTLLIB = re.compile(rb"^mtllib (.*\S)", re.MULTILINE)


def _numbered_obj_lines(content: bytes) -> Iterator[tuple[int, bytes]]:
    """Yield the lines of an OBJ that state a vertex or a face, with their numbers in the file."""
    number, end = 1, 0
    for match in _OBJ_LINE.finditer(content):
        number += content.count(b"\n", end, match.start())
        end = match.start()
        yield number, match[0]


def _obj_vertices(path: Path, content: bytes, text: bytes) -> FloatArray:
    if not text:
        return np.empty((0, 3))
    with contextlib.suppress(ValueError):  # a line with fewer numbers, or with something else
        vertices = np.loadtxt(io.BytesIO(text), np.float64, comments=None, usecols=(0, 1, 2), ndmin=2)
        if np.isfinite(vertices).all() and len(vertices) == text.count(b"\n") + 1:
            return vertices
    for number, line in _numbered_obj_lines(content):
        if line.startswith(b"v") and (len(line.split()) < 4 or not _are_numbers(line.split()[1:4])):
            raise _unreadable(path, f"line {number}", "a vertex needs three finite numbers")
    raise _unreadable(path, "vertices", "they are not rows of three numbers")


def _obj_triangles_at_once(text: bytes) -> NDArray[np.int64] | None:
    """Return the faces as indices, or None unless all of them are triangles whose corners count from the first vertex."""
    table = re.sub(rb"/\S*", b"", text)
    if not table or table.translate(None, b"0123456789 \t\n"):
        return None
    with contextlib.suppress(ValueError):  # faces with different numbers of corners, or a number beyond 2⁶³
        corners = np.loadtxt(io.BytesIO(table), np.int64, comments=None, ndmin=2)
        if corners.shape == (table.count(b"\n") + 1, 3):
            return corners - 1
    return None


def _obj_faces_one_by_one(path: Path, content: bytes, total: int) -> NDArray[np.int64]:
    """Read polygons, triangulated as fans from their first corner, and negative indices, which count back from the last vertex so far."""
    triangles: list[tuple[int, int, int]] = []
    known = 0
    for number, line in _numbered_obj_lines(content):
        if line.startswith(b"v"):
            known += 1
            continue
        try:
            corners = [int(word.split(b"/")[0]) for word in line.split()[1:]]
        except ValueError:
            raise _unreadable(path, f"line {number}", "a face needs whole numbers") from None
        corners = [corner - 1 if corner > 0 else known + corner for corner in corners]
        if len(corners) < 3:
            raise _unreadable(path, f"line {number}", f"a face needs three corners, not {len(corners)}")
        if min(corners) < 0 or max(corners) >= total:
            raise _unreadable(path, f"line {number}", f"a face names a vertex that does not exist; there are {total}")
        triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return np.array(triangles, dtype=np.int64).reshape(-1, 3)


def _read_with_trimesh(path: Path, content: bytes) -> TriMesh:
    """Read GLB, PLY or DAE; nodes of a scene are placed and merged.

    Only the content of the file is read: external buffers and pictures of a glTF are not loaded.
    """
    import trimesh  # noqa: PLC0415  half a second, for two formats

    kind = path.suffix.lower().lstrip(".")
    _require_whole(path, kind, content)
    unit = 1.0
    if kind == "dae":
        unit, content = _bounded_dae(path, content)
    elif kind in {"glb", "gltf"}:
        _require_bounded_gltf(path, content)
    elif content.partition(b"end_header")[0].find(b"ascii") >= 0:
        _require_few(path, _words(content), MAX_WORDS, "words")
    scene = trimesh.load_scene(io.BytesIO(content), file_type=kind, process=False)
    _require_few(path, len(scene.graph.nodes_geometry), MAX_NODES, "placed shapes")
    shapes = (scene.geometry[scene.graph[node][1]] for node in scene.graph.nodes_geometry)
    _require_few(path, sum(len(getattr(shape, "faces", ())) for shape in shapes), MAX_TRIANGLES, "triangles")
    pieces = [piece for piece in scene.dump(concatenate=False) if isinstance(piece, trimesh.Trimesh)]
    meshes = [TriMesh(np.asarray(piece.vertices, dtype=np.float64) * unit, np.asarray(piece.faces, dtype=np.int32)) for piece in pieces]
    if not meshes:
        raise _unreadable(path, "file", "it holds no triangle mesh")
    return merged(meshes).welded()


_DAE_LOOKS = ("{*}bind_material", "{*}library_materials", "{*}library_effects", "{*}library_images")
"""DAE elements about appearance: a missing material would make its mesh unreadable."""


_DAE_ENCODINGS = frozenset({b"utf-8", b"utf8", b"us-ascii", b"iso-8859-1", b"windows-1252"})
"""Encodings in which each tag begins with a byte `<`, so that tags can be counted: not so in UTF-7, UTF-16 and EBCDIC."""


def _unit_of_dae(root: Any) -> float:
    """Return the size of one unit of a DAE in metres: `<asset><unit meter="…"/>`, 1 if none is stated."""
    stated = root.find("{*}asset/{*}unit[@meter]")
    unit = 1.0 if stated is None else float(stated.get("meter"))
    if not 0 < unit < math.inf:
        raise ValueError(f"the unit of {unit} m is not a valid length")
    return unit


def _bounded_dae(path: Path, content: bytes) -> tuple[float, bytes]:
    """Return the unit of a DAE, and its text as UTF-8 without a document type and appearances, whose nodes place few shapes.

    Nodes may place other nodes, and those others again: thirty lines can place 2³⁰ shapes. The number of visits of a node's shapes is
    the sum over the nodes that it places, counted once for each node.

    Raises:
        ReadError: If nodes place themselves, or more than `MAX_NODES` shapes in all.
    """
    _require_few(path, content.count(b"<"), MAX_MARKS, "tags")
    _require_few(path, _words(content), MAX_DAE_WORDS, "words")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True)
    root = etree.fromstring(content, parser)
    if root.getroottree().docinfo.internalDTD is not None:
        raise _unreadable(path, "line 1", "a DAE must be plain XML, without entities and not compressed")
    for look in list(root.iter(*_DAE_LOOKS)):
        if look.getparent() is not None:
            look.getparent().remove(look)
    nodes = {node.get("id"): node for node in root.iter("{*}node") if node.get("id")}
    counts: dict[Any, float] = {}
    stack = [(node, False) for node in root.iter("{*}node")]
    opened = set()
    while stack:
        node, is_counted = stack.pop()
        if node in counts:
            continue
        below = [*node.iterchildren("{*}node")]
        below += [nodes[name] for use in node.iterchildren("{*}instance_node") if (name := use.get("url", "").lstrip("#")) in nodes]
        if is_counted:
            counts[node] = 1.0 + sum(counts[one] for one in below)
            _require_few(path, counts[node], MAX_NODES, "placed shapes")
            opened.discard(node)
            continue
        if node in opened:
            raise _unreadable(path, f"line {node.sourceline}", "a node places itself")
        opened.add(node)
        stack.append((node, True))
        stack += [(one, False) for one in below]
    return _unit_of_dae(root), bytes(etree.tostring(root, encoding="utf-8"))


def _require_bounded_gltf(path: Path, content: bytes) -> None:
    """Refuse a glTF that states too many triangles, nodes or other objects, before trimesh builds them.

    Several primitives and nodes may share one buffer, so that the size of the file bounds nothing.
    """
    length = struct.unpack_from("<I", content, 12)[0] if content[:4] == b"glTF" else 0
    text = content[20 : 20 + length] if content[:4] == b"glTF" else content
    _require_few(path, sum(text.count(mark) for mark in (b"[", b"{", b",")), MAX_MARKS, "values")
    document = json.loads(text)
    nodes, accessors = document.get("nodes", []), document.get("accessors", [])
    _require_few(path, len(nodes), MAX_NODES, "nodes")
    uses = Counter(node.get("mesh") for node in nodes)
    corners = 0
    for number, mesh in enumerate(document.get("meshes", [])):
        for primitive in mesh["primitives"]:
            corner = primitive.get("indices", primitive.get("attributes", {}).get("POSITION"))
            corners += max(uses[number], 1) * (accessors[corner]["count"] if corner is not None else 0)
    _require_few(path, corners / 3, MAX_TRIANGLES, "triangles")
    _require_few(path, sum(abs(accessor["count"]) for accessor in accessors), 12 * MAX_TRIANGLES, "values")


def _words(content: bytes) -> int:
    """Return the number of words in a text, without making a list of them."""
    total, inside = 0, False
    for at in range(0, len(content), 1 << 20):
        word = np.frombuffer(content, np.uint8, min(1 << 20, len(content) - at), at) > ord(" ")
        total += int(np.count_nonzero(word[1:] & ~word[:-1])) + int(word[0] and not inside)
        inside = bool(word[-1])
    return total


def _require_few(path: Path, count: float, most: int, what: str) -> None:
    if not count <= most:  # also refuses NaN
        raise _unreadable(path, "file", f"it has {count:.0f} {what}; the maximum is {most}")


def _require_whole(path: Path, kind: str, content: bytes) -> None:
    if kind == "glb":
        if len(content) < 20 or content[:4] != b"glTF":
            raise _unreadable(path, "byte 0", "a GLB begins with 'glTF' and has at least 20 bytes")
        announced = struct.unpack_from("<I", content, 8)[0]
        if announced > len(content):
            raise _unreadable(path, f"byte {len(content)}", f"its header announces {announced} bytes; is it truncated?")
    if kind == "dae" and (not _is_countable(content) or b"<!DOCTYPE" in content or b"<!ENTITY" in content):
        raise _unreadable(path, "byte 0", "a DAE must be plain XML, without entities and not compressed")
    if kind == "ply" and b"end_header" not in content:
        raise _unreadable(path, "header", "it has no 'end_header'")


def _is_countable(content: bytes) -> bool:
    """Return whether a text begins as XML in one of `_DAE_ENCODINGS`; its declaration must end within 1,000 bytes."""
    beginning = content[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
    declaration, end, _ = beginning.partition(b"?>") if beginning.startswith(b"<?xml") else (b"", b"?>", b"")
    stated = re.search(rb"encoding\s*=\s*[\"']([\w.-]*)", declaration)
    return bool(end) and re.match(rb"<[^\0]", beginning) is not None and (stated is None or stated[1].lower() in _DAE_ENCODINGS)


def _checked(path: Path, read: Callable[[], TriMesh]) -> TriMesh:
    """Run a reader on untrusted bytes; any exception means that the file is invalid."""
    try:
        return read()
    except ReadError:
        raise
    except ArticadError as error:
        raise _unreadable(path, "arrays", error.message) from error
    except (MemoryError, RecursionError) as error:
        raise _unreadable(path, "file", "it needs too much memory") from error
    except Exception as error:  # trimesh raises whatever its parsers raise
        raise _unreadable(path, "file", f"{type(error).__name__}: {error}") from error


def _unreadable(path: Path, where: str, reason: str) -> ReadError:
    finding = Finding(
        code="E_READ",
        where=f"{path.name}, {where}",
        message=f"{path.name} cannot be read at {where}: {reason}.",
        hint="Export the mesh again as STL, OBJ, GLB, PLY or DAE.",
    )
    return ReadError(finding.message, path=str(path), where=where, findings=[finding])


_READERS: dict[str, Callable[[Path, bytes], TriMesh]] = {
    ".stl": _read_stl,
    ".obj": _read_obj,
    ".glb": _read_with_trimesh,
    ".gltf": _read_with_trimesh,
    ".ply": _read_with_trimesh,
    ".dae": _read_with_trimesh,
}

MESH_ENDINGS = tuple(_READERS)
"""Endings of the files that `read_mesh` reads."""
