"""More than a hundred files that were made to exhaust whoever reads them: memory, time, recursion, or the room on the disk.

Each entry writes its files into a folder and returns the words of the command that reads them. Sizes are those that hurt a reader without
bounds: exponents of nesting, counts that a header claims, products of two plausible numbers.
"""

from __future__ import annotations

import io
import json
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.geometry.test_dae import DAE
from tests.planting import written_sparse

Write = Callable[[Path], str]
ENTRIES: dict[str, Write] = {}
N, MANY, HUGE = 20_000, 300_000, 10**9
DIGITS = "9" * 2_000_000


def entry(name: str, write: Write) -> None:
    assert name not in ENTRIES
    ENTRIES[name] = write


def text(name: str, file: str, content: Callable[[], str | bytes], words: str) -> None:
    def write(folder: Path) -> str:
        made = content()
        (folder / file).write_bytes(made.encode() if isinstance(made, str) else made)
        return words.replace("FILE", file)

    entry(name, write)


# ---------------------------------------------------------------------- URDF

READ, AUDIT = "convert FILE out.3mf", "audit FILE --budget 1"
LINK = '<link name="{}"/>'
JOINT = (
    '<joint name="j{0}" type="{3}"><parent link="l{1}"/><child link="l{2}"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/>{4}</joint>'
)


def robot(inside: str) -> str:
    return f'<robot name="r">{inside}</robot>'


def links(count: int) -> str:
    return "".join(LINK.format(f"l{number}") for number in range(count))


def chain(count: int, kind: str = "revolute", more: str = "") -> str:
    return links(count) + "".join(JOINT.format(i, i - 1, i, kind, more.format(i - 1)) for i in range(1, count))


def shaped(geometry: str, count: int = 1) -> str:
    return robot(
        "".join(
            f'<link name="l{i}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
            f"<visual><geometry>{geometry}</geometry></visual><collision><geometry>{geometry}</geometry></collision></link>"
            for i in range(count)
        )
        + "".join(JOINT.format(i, 0, i, "revolute", "") for i in range(1, count))
    )


URDFS: dict[str, Callable[[], str]] = {
    "attributes": lambda: robot("<link " + " ".join(f'a{i}="1"' for i in range(MANY)) + "/>"),
    "levels": lambda: "<robot>" * MANY,
    "closed levels": lambda: robot("<a>" * 40_000 + "</a>" * 40_000),
    "elements": lambda: robot("<a/>" * 2_000_000),
    "a long name": lambda: robot(f'<link name="{"a" * 20_000_000}"/>'),
    "long text": lambda: robot('<link name="a"/>' + "x" * 60_000_000),
    "a number of many digits": lambda: robot(f'<link name="a"><inertial><mass value="{DIGITS}"/></inertial></link>'),
    "many numbers": lambda: robot(f'<link name="a"><inertial><origin xyz="{"1 " * 5_000_000}"/></inertial></link>'),
    "entities": lambda: '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>' + robot('<link name="&b;"/>'),
    "an external entity": lambda: '<!DOCTYPE r SYSTEM "file:///dev/zero" [<!ENTITY % a SYSTEM "file:///dev/zero"> %a;]>' + robot(""),
    "namespaces": lambda: "<robot " + " ".join(f'xmlns:n{i}="u{i}"' for i in range(MANY)) + "/>",
    "a new namespace each level": lambda: "".join(f'<n{i}:a xmlns:n{i}="u{i}">' for i in range(30_000)),
    "comments": lambda: robot("<!---->" * 3_000_000),
    "links": lambda: robot(links(100_000)),
    "a long chain": lambda: robot(chain(N)),
    "a long chain of fixed joints": lambda: robot(chain(N, "fixed")),
    "mimics of mimics": lambda: robot(chain(4000, more='<mimic joint="j{}" multiplier="2"/>')),
    "mimics in a circle": lambda: robot(
        links(3) + JOINT.format(1, 0, 1, "revolute", '<mimic joint="j2"/>') + JOINT.format(2, 0, 2, "revolute", '<mimic joint="j1"/>')
    ),
    "joints of the same two links": lambda: robot(links(2) + "".join(JOINT.format(i, 0, 1, "revolute", "") for i in range(N))),
    "materials": lambda: robot("".join(f'<material name="m{i}"><color rgba="1 1 1 1"/></material>' for i in range(200_000)) + links(1)),
    "shapes of one link": lambda: robot(
        '<link name="a">' + '<collision><geometry><box size="1 1 1"/></geometry></collision>' * 20_000 + "</link>"
    ),
    "a box as large as numbers": lambda: shaped('<box size="1e308 1e308 1e308"/>', 3),
    "a sphere as small as numbers": lambda: shaped('<sphere radius="5e-324"/>', 3),
    "scales": lambda: shaped('<mesh filename="nothing.stl" scale="1e300 1e-300 0"/>', 200),
    "records": lambda: robot(links(1) + "<articad>" + '{"kind": "part"}\n' * 500_000 + "</articad>"),
    "records of deep lists": lambda: robot(links(1) + "<articad>" + "[" * 5_000_000 + "</articad>"),
    "records of one number": lambda: robot(links(1) + f'<articad>{{"kind": "assembly", "version": {DIGITS}}}</articad>'),
    "an encoding": lambda: '<?xml version="1.0" encoding="utf-7"?>' + robot(links(1000)),
    "shapes that overlap": lambda: shaped('<box size="1 1 1"/>', 1500),
}
for _name, _content in URDFS.items():
    text(f"urdf: {_name}", "a.urdf", _content, AUDIT)

# ---------------------------------------------------------------------- MJCF

GEOM = '<geom size="0.1"/>'


def mujoco(inside: str, world: str = GEOM) -> str:
    return f"<mujoco>{inside}<worldbody>{world}</worldbody></mujoco>"


def asset(inside: str) -> str:
    return mujoco(f"<asset>{inside}</asset>")


MJCFS: dict[str, Callable[[], str]] = {
    "copies": lambda: mujoco("", f'<replicate count="{HUGE}">{GEOM}</replicate>'),
    "copies of copies": lambda: mujoco("", '<replicate count="900">' * 4 + GEOM + "</replicate>" * 4),
    "copies of defaults": lambda: mujoco("", ('<replicate count="990">' + f"<body>{GEOM}</body>" + "</replicate>") * 190),
    "a composite": lambda: mujoco("", f'<body><composite type="cable" count="{HUGE} 1 1" size="1"/></body>'),
    "a flexcomp": lambda: mujoco("", '<body><flexcomp type="grid" count="999 999 999" spacing="1 1 1" name="f"/></body>'),
    "a texture of the machine": lambda: asset('<texture type="2d" builtin="checker" width="1000000" height="1000000" name="t"/>'),
    "a texture of two gigabytes": lambda: asset('<texture type="2d" builtin="gradient" width="26000" height="26000" name="t"/>'),
    "a height field": lambda: asset('<hfield name="h" nrow="40000" ncol="40000" size="1 1 1 1"/>'),
    "a built-in mesh": lambda: asset('<mesh name="m" builtin="sphere" params="14"/>'),
    "a mesh of one line": lambda: asset(f'<mesh name="m" vertex="{"0 0 1 " * 1_000_000}"/>'),
    "memory": lambda: mujoco('<size memory="1000T"/>'),
    "keys": lambda: mujoco(f'<size nkey="{HUGE}"/>'),
    "user data": lambda: mujoco(f'<size nuserdata="{HUGE}" nuser_body="{HUGE}"/>'),
    "a chain of bodies": lambda: mujoco("", f"<body><joint/>{GEOM}" * 8000 + "</body>" * 8000),
    "a deep default": lambda: mujoco("".join(f'<default class="c{i}">' for i in range(8000)) + "</default>" * 8000),
    "pairs": lambda: mujoco(
        "<contact>" + '<exclude body1="a" body2="b"/>' * 100_000 + "</contact>",
        f'<body name="a">{GEOM}</body><body name="b">{GEOM}</body>',
    ),
    "bodies in one place": lambda: mujoco("", f"<body><freejoint/>{GEOM}</body>" * 1500),
    "equalities": lambda: mujoco(
        "<equality>" + '<connect body1="a" body2="b" anchor="0 0 0"/>' * 2000 + "</equality>",
        f'<body name="a"><joint/>{GEOM}</body><body name="b"><joint/>{GEOM}</body>',
    ),
    "a plugin": lambda: mujoco('<extension><plugin plugin="/tmp/x.so"/></extension>'),
    "a script": lambda: mujoco("", f"<body><joint/>{GEOM}</body>").replace("<mujoco>", '<mujoco><compiler strippath="false" meshdir="/"/>'),
    "an include of everything": lambda: '<mujoco><include file="/dev/zero"/></mujoco>',
    "includes of the same": lambda: "<mujoco>" + '<include file="a.xml"/>' * 1000 + "</mujoco>",
    "NaN": lambda: mujoco('<option gravity="nan nan nan" timestep="1e-300"/>', f"<body><freejoint/>{GEOM}</body>"),
    "levels": lambda: "<mujoco>" * MANY,
    "a tendon": lambda: mujoco(
        "<tendon><spatial>" + '<site site="s"/>' * 30_000 + "</spatial></tendon>", f'<body><joint/>{GEOM}<site name="s"/></body>'
    ),
}
for _name, _content in MJCFS.items():
    text(f"mjcf: {_name}", "a.xml", _content, AUDIT)

# ---------------------------------------------------------------------- SDF, SRDF, xacro

MODEL = '<sdf version="1.9"><model name="m">{}</model></sdf>'
SDFS: dict[str, Callable[[], str]] = {
    "models in models": lambda: MODEL.format('<model name="n"><link name="a"/>' * 10_000 + "</model>" * 10_000),
    "frames of frames": lambda: MODEL.format(
        '<link name="a"/><frame name="f0" attached_to="a"/>'
        + "".join(f'<frame name="f{i}" attached_to="f{i - 1}"><pose relative_to="f{i - 1}">0 0 1 0 0 0</pose></frame>' for i in range(1, N))
    ),
    "frames in a circle": lambda: MODEL.format('<link name="a"/><frame name="f" attached_to="g"/><frame name="g" attached_to="f"/>'),
    "an include of itself": lambda: MODEL.format("<include><uri>a.sdf</uri></include>"),
    "links": lambda: MODEL.format("".join(f'<link name="l{i}"/>' for i in range(100_000))),
    "a polyline": lambda: MODEL.format(
        '<link name="a"><visual name="v"><geometry><polyline>' + "<point>0 0</point>" * 300_000
        + "<height>1</height></polyline></geometry></visual></link>"
    ),
}  # fmt: skip
for _name, _content in SDFS.items():
    text(f"sdf: {_name}", "a.sdf", _content, AUDIT)

XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}<link name="a"/></robot>'
XACROS: dict[str, Callable[[], str]] = {
    "a long text": lambda: XACRO.format("<link name=\"${'a' * 10**10}\"/>"),
    "a large power": lambda: XACRO.format('<link name="${9**9**9}"/>'),
    "a macro of itself": lambda: XACRO.format('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>'),
    "macros that double": lambda: XACRO.format(
        '<xacro:macro name="m0"><b/></xacro:macro>'
        + "".join(f'<xacro:macro name="m{i}"><xacro:m{i - 1}/><xacro:m{i - 1}/></xacro:macro>' for i in range(1, 40))
        + "<xacro:m39/>"
    ),
    "an endless list": lambda: XACRO.format('<link name="${[x for x in range(10**11)]}"/>'),
}
for _name, _content in XACROS.items():
    text(f"xacro: {_name}", "a.urdf.xacro", _content, READ)


def srdf(folder: Path) -> str:
    (folder / "a.urdf").write_text(robot(chain(3)))
    (folder / "a.srdf").write_text(robot('<disable_collisions link1="l0" link2="l1"/>' * 900_000))
    return "convert a.urdf out.urdf"


entry("srdf: pairs", srdf)

# ---------------------------------------------------------------------- meshes


def mesh(name: str, file: str, content: Callable[[], bytes], size: int = 0) -> None:
    def write(folder: Path) -> str:
        (folder / "a.urdf").write_text(shaped(f'<mesh filename="{file}"/>'))
        written_sparse(folder / file, content(), size)
        return "audit a.urdf --budget 1"

    entry(f"mesh: {name}", write)


def glb(document: dict[str, Any], binary: bytes = b"") -> bytes:
    words = json.dumps({"asset": {"version": "2.0"}} | document).encode()
    words += b" " * (-len(words) % 4)
    tail = struct.pack("<I4s", len(binary), b"BIN\0") + binary if binary else b""
    return struct.pack("<4sII", b"glTF", 2, 20 + len(words) + len(tail)) + struct.pack("<I4s", len(words), b"JSON") + words + tail


def doubled(depth: int) -> list[dict[str, Any]]:
    """Return nodes of which each holds the next one twice."""
    return [{"children": [i + 1, i + 1], "mesh": 0} for i in range(depth)] + [{"mesh": 0}]


TRIANGLE = [{"primitives": [{"attributes": {"POSITION": 0}}]}]
POINTS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
VIEWS: dict[str, Any] = {"buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}]}


def accessor(count: int, view: bool = True) -> dict[str, Any]:
    return {"accessors": [{"componentType": 5126, "type": "VEC3", "count": count} | ({"bufferView": 0} if view else {})]} | VIEWS


def dae_doubled() -> bytes:
    nodes = "".join(f'<node id="n{i}"><instance_node url="#n{i + 1}"/><instance_node url="#n{i + 1}"/></node>' for i in range(30))
    whole = DAE.format(unit="", up="Z_UP").replace(
        "<library_visual_scenes>", f"<library_nodes>{nodes}<node id='n30'/></library_nodes><library_visual_scenes>"
    )
    return whole.replace("</node></visual_scene>", '<instance_node url="#n0"/></node></visual_scene>').encode()


def dae_of_entities() -> str:
    """Return a DAE with entities that grow tenfold at each of nine levels."""
    entities = '<!ENTITY e0 "0 0 0 0 0 0 0 0 0 0">' + "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 9))
    plain = DAE.format(unit="", up="Z_UP").replace("0 0 0 1 0 0", "&e8;")
    return plain.replace("?><COLLADA", f"?><!DOCTYPE COLLADA [{entities}]><COLLADA")


STL = b"articad".ljust(80)
PLY = "ply\nformat {}\nelement vertex {}\n{}element face {}\nproperty list uchar int vertex_indices\nend_header\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
mesh("an STL that claims four billion", "a.stl", lambda: STL + struct.pack("<I", 2**32 - 1) + bytes(5000))
mesh("an STL of nothing, 1 GiB", "a.stl", lambda: STL + struct.pack("<I", ((1 << 30) - 84) // 50), (1 << 30) - ((1 << 30) - 84) % 50)
mesh(
    "an STL of nothing, 400 MiB", "a.stl", lambda: STL + struct.pack("<I", ((400 << 20) - 84) // 50), (400 << 20) - ((400 << 20) - 84) % 50
)
mesh("an STL of nothing, as large as one may be", "a.stl", lambda: STL + struct.pack("<I", 1_000_000), 84 + 1_000_000 * 50)
mesh("an STL of short words", "a.stl", lambda: b"solid " + b"xx " * 40_000_000)
mesh("an STL of 100 GiB", "a.stl", lambda: STL, 100 << 30)
mesh("an STL of words", "a.stl", lambda: b"solid " + b"x " * 20_000_000)
mesh("an STL of digits", "a.stl", lambda: b"solid a\nfacet normal 0 0 " + DIGITS.encode())
mesh("an OBJ of far corners", "a.obj", lambda: b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\nf -9 2 3\n")
mesh("an OBJ of one face", "a.obj", lambda: b"v 0 0 0\n" * 300_000 + b"f " + b" ".join(b"%d" % i for i in range(1, 300_001)))
mesh("an OBJ of digits", "a.obj", lambda: b"v 0 0 " + DIGITS.encode())
mesh("an OBJ of empty lines", "a.obj", lambda: b"\n" * 60_000_000)
mesh("an OBJ of groups", "a.obj", lambda: b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"g a\nusemtl b\nf 1 2 3\n" * 500_000)
mesh("a PLY that claims four billion", "a.ply", lambda: PLY.format("ascii 1.0", 4_000_000_000, XYZ, 1).encode() + b"0 0 0\n")
mesh("a binary PLY that claims it", "a.ply", lambda: PLY.format("binary_little_endian 1.0", 4_000_000_000, XYZ, 1).encode() + bytes(99))
mesh("a PLY of properties", "a.ply", lambda: PLY.format("ascii 1.0", 3, "".join(f"property float p{i}\n" for i in range(MANY)), 1).encode())
mesh("a PLY of elements", "a.ply", lambda: b"ply\nformat ascii 1.0\n" + b"element a 0\n" * MANY + b"end_header\n")
mesh("a PLY whose faces are long", "a.ply", lambda: PLY.format("binary_little_endian 1.0", 3, XYZ, 100_000).encode() + b"\xff" * 9_000_000)
mesh(
    "a glTF of nodes that double",
    "a.glb",
    lambda: glb({"nodes": doubled(30), "scenes": [{"nodes": [0]}], "meshes": TRIANGLE} | accessor(3), POINTS),
)
mesh(
    "a glTF of nodes in a circle",
    "a.glb",
    lambda: glb({"nodes": [{"children": [0], "mesh": 0}], "scenes": [{"nodes": [0]}], "meshes": TRIANGLE} | accessor(3), POINTS),
)
mesh(
    "a glTF that claims four billion",
    "a.glb",
    lambda: glb({"meshes": TRIANGLE, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]} | accessor(2**32, view=False)),
)
mesh("a glTF that claims more than it has", "a.glb", lambda: glb({"meshes": TRIANGLE, "nodes": [{"mesh": 0}]} | accessor(HUGE), POINTS))
mesh(
    "a glTF of nodes",
    "a.glb",
    lambda: glb({"meshes": TRIANGLE, "nodes": [{"mesh": 0}] * 100_000, "scenes": [{"nodes": list(range(100_000))}]} | accessor(3), POINTS),
)
mesh(
    "a glTF of one shape in many places",
    "a.glb",
    lambda: glb({"meshes": [{"primitives": TRIANGLE[0]["primitives"] * 3000}], "nodes": [{"mesh": 0}] * 3000} | accessor(3), POINTS),
)
mesh("a glTF of empty objects", "a.gltf", lambda: b'{"asset": {"version": "2.0"}, "extras": [' + b"{}," * 20_000_000 + b"{}]}")
mesh("a glTF of deep lists", "a.glb", lambda: struct.pack("<4sIII4s", b"glTF", 2, 2_000_020, 2_000_000, b"JSON") + b"[" * 2_000_000)
mesh(
    "a glTF of another file",
    "a.gltf",
    lambda: json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 9, "uri": "/dev/zero"}]} | {"meshes": TRIANGLE}).encode(),
)
mesh("a DAE of nodes that double", "a.dae", dae_doubled)
mesh(
    "a DAE of nodes in a circle",
    "a.dae",
    lambda: dae_doubled().replace(b"<node id='n30'/>", b'<node id="n30"><instance_node url="#n0"/></node>'),
)
mesh("a DAE of entities in UTF-16", "a.dae", lambda: (chr(0xFEFF) + dae_of_entities()).encode("utf-16-le"))
mesh("a DAE of numbers", "a.dae", lambda: DAE.format(unit="", up="Z_UP").replace("0 0 0 1 0 0", "1 " * 8_000_000).encode())
mesh("a DAE of a unit", "a.dae", lambda: DAE.format(unit=f'<unit meter="{DIGITS}"/>', up="Z_UP").encode())

# ---------------------------------------------------------------------- FreeCAD, STEP


def archive(**files: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in files.items():
            made.writestr(name.replace("_xml", ".xml"), content)
    return stream.getvalue()


def overlapping() -> bytes:
    """Return an archive whose ten thousand entries are all the same compressed bytes, a bomb without nesting."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    kernel = packer.compress(bytes(60 << 20)) + packer.flush()
    crc, names = zlib.crc32(bytes(60 << 20)), [b"Document.xml", *(b"%06d.brp" % i for i in range(10_000))]
    local = struct.pack("<4s5H3I2H", b"PK\3\4", 20, 0, 8, 0, 0, crc, len(kernel), 60 << 20, 12, 0) + names[0] + kernel
    table = b"".join(
        struct.pack("<4s6H3I5H2I", b"PK\1\2", 20, 20, 0, 8, 0, 0, crc, len(kernel), 60 << 20, len(n), 0, 0, 0, 0, 0, 0) + n for n in names
    )
    return local + table + struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, len(names), len(names), len(table), len(local), 0)


def document(objects: str) -> bytes:
    return archive(Document_xml=f'<Document SchemaVersion="4"><Properties Count="0"/>{objects}</Document>'.encode())


FCSTDS: dict[str, Callable[[], bytes]] = {
    "a bomb": lambda: archive(Document_xml=bytes(1 << 30)),
    "a bomb of spaces": lambda: archive(Document_xml=b"<Document>" + b" " * (60 << 20) + b"</Document>"),
    "a bomb of attributes": lambda: archive(Document_xml=("<Document " + " ".join(f'a{i}="1"' for i in range(MANY)) + "/>").encode()),
    "entries in one place": overlapping,
    "entries": lambda: archive(**{f"f{i}": b"" for i in range(60_000)}),
    "objects": lambda: document(
        "<Objects>" + "".join(f'<Object name="o{i}" type="Part::Feature"/>' for i in range(200_000)) + "</Objects>"
    ),
    "levels": lambda: document("<a>" * 45_000 + "</a>" * 45_000),
    "nothing but a header": lambda: b"PK\3\4" + bytes(50_000_000),
}


def shown(objects: dict[str, tuple[str, str]], *, colored: bool = False) -> bytes:
    """Return a document whose assembly shows objects of these types and properties, of which the first one is grounded."""
    top = linked("Group", [name for name in objects if name[0] != "_"] + ["G"])
    objects = {"A": ("Assembly::AssemblyObject", top), "G": ("App::FeaturePython", linked("ObjectToGround", ["p0"]))} | objects
    rows = "".join(f'<Object name="{name}" type="{kind}"/>' for name, (kind, _) in objects.items())
    data = "".join(f'<Object name="{name}"><Properties>{inside}</Properties></Object>' for name, (_, inside) in objects.items())
    text = f"<Document><Objects>{rows}</Objects><ObjectData>{data}</ObjectData></Document>"
    color = '<Properties><Property name="ShapeColor"><PropertyColor value="255"/></Property></Properties>'
    painted = "".join(f'<ViewProvider name="{name}">{color}</ViewProvider>' for name in objects if colored)
    gui = f"<Document><ViewProviderData>{painted}</ViewProviderData></Document>"
    return archive(Document_xml=text.encode(), GuiDocument_xml=gui.encode())


def linked(key: str, names: list[str]) -> str:
    return f'<Property name="{key}"><LinkList>{"".join(f"<Link value={name!r}/>" for name in names)}</LinkList></Property>'


def string(key: str, value: str) -> str:
    return f'<Property name="{key}"><String value="{value}"/></Property>'


def of_one_label(count: int) -> dict[str, tuple[str, str]]:
    return {f"p{place}": ("App::Part", string("Label", "same")) for place in range(count)}


def all_grounded() -> bytes:
    grounded = {f"_g{place}": ("App::FeaturePython", linked("ObjectToGround", [f"p{place}"])) for place in range(14_000)}
    return shown(of_one_label(14_000) | grounded | {"J": ("Assembly::JointGroup", linked("Group", list(grounded)))})


def one_folder(kind: str) -> bytes:
    """Return a document of thousands of parts that share a group of thousands of shapes."""
    shapes = {f"_s{place}": ("App::Part", "") for place in range(9_000)}
    folder = {"_f": (kind, linked("Group", list(shapes)))}
    return shown({f"p{place}": ("App::Part", linked("Group", ["_f"])) for place in range(9_000)} | folder | shapes)


def copies(kind: str, inside: str) -> bytes:
    """Return a document of thousands of links to one part that has thousands of objects."""
    held = {f"_s{place}": (kind, inside.format(place)) for place in range(9_000)}
    part = {"p0": ("App::Part", linked("Group", list(held)))}
    return shown(part | {f"p{place}": ("App::Link", linked("LinkedObject", ["p0"])) for place in range(1, 9_000)} | held)


FCSTDS |= {
    "parts of one label": lambda: shown(of_one_label(15_000)),
    "parts of one label and colour": lambda: shown(of_one_label(15_000), colored=True),
    "parts that are all grounded": all_grounded,
    "parts with one folder": lambda: one_folder("App::DocumentObjectGroup"),
    "parts with one part in them": lambda: one_folder("App::Part"),
    "copies of a part of many connectors": lambda: copies("PartDesign::CoordinateSystem", string("ArticadConnector", "c{}")),
    "copies of a part of many shapes": lambda: copies("Part::Feature", '<Property name="Shape"><Part file=""/></Property>'),
}


def listing(folder: Path) -> str:
    """A document that lists two hundred others, each a small archive of a large text."""
    part = archive(Document_xml=b"<Document><Objects/><ObjectData/>" + b" " * (60 << 20) + b"</Document>")
    for number in range(200):
        (folder / f"{number}.FCStd").write_bytes(part)
    (folder / "a.FCStd").write_bytes(archive(Document_xml=listing_document([f"{number}.FCStd" for number in range(200)])))
    return "audit a.FCStd --budget 1"


def listing_document(files: list[str]) -> bytes:
    row = f'<Property name="ArticadFiles" type="App::PropertyString"><String value="{"&#10;".join(files)}"/></Property>'
    data = f'<ObjectData Count="1"><Object name="A"><Properties>{row}</Properties></Object></ObjectData>'
    return f'<Document SchemaVersion="4"><Objects Count="1"><Object name="A" type="Assembly::AssemblyObject"/></Objects>{data}</Document>'.encode()


entry("fcstd: two hundred documents", listing)
for _name, _data in FCSTDS.items():
    text(f"fcstd: {_name}", "a.FCStd", _data, AUDIT)

STEP = "ISO-10303-21;HEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;DATA;{}ENDSEC;END-ISO-10303-21;"
STEPS: dict[str, Callable[[], str]] = {
    "lists": lambda: STEP.format("#1=X(" + "(" * 500_000 + ")" * 500_000 + ");"),
    "entities": lambda: STEP.format("".join(f"#{i}=CARTESIAN_POINT('',(0.,0.,0.));" for i in range(1, 500_000))),
    "a text": lambda: STEP.format("#1=X('" + "a" * 50_000_000 + "');"),
    "a circle": lambda: STEP.format("#1=SHELL_BASED_SURFACE_MODEL('',(#2));#2=OPEN_SHELL('',(#1,#2));"),
    "no end": lambda: STEP[:60] + "/*" + "*" * 30_000_000,
}
for _name, _content in STEPS.items():
    text(f"step: {_name}", "a.step", _content, READ)

# ---------------------------------------------------------------------- plans, certificates, batches

PLANS: dict[str, Callable[[], str]] = {
    "deep lists": lambda: "[" * 10_000_000,
    "deep objects": lambda: '{"a":' * 3_000_000,
    "a number": lambda: '{"name": "a", "parameters": {"x": ' + DIGITS + "}}",
    "a power": lambda: json.dumps({"name": "a", "parameters": {"x": 9, "y": "x**x**x**x**x"}, "parts": [], "joints": []}),
    "parentheses": lambda: json.dumps({"name": "a", "parameters": {"x": "(" * 500_000 + "1" + ")" * 500_000}, "parts": [], "joints": []}),
    "a long sum": lambda: json.dumps({"name": "a", "parameters": {"x": "1+" * 500_000 + "1"}, "parts": [], "joints": []}),
    "parameters of parameters": lambda: json.dumps(
        {"name": "a", "parameters": {"p0": 1.0} | {f"p{i}": f"p{i - 1}+p{i - 1}" for i in range(1, 20_000)}, "parts": [], "joints": []}
    ),
    "parameters": lambda: json.dumps({"name": "a", "parameters": {f"p{i}": 1 for i in range(MANY)}, "parts": [], "joints": []}),
    "parts": lambda: json.dumps({"name": "a", "parts": [{"name": f"p{i}"} for i in range(100_000)], "joints": []}),
    "one name": lambda: json.dumps({"name": "a" * 10_000_000, "parts": [], "joints": []}),
}
for _name, _content in PLANS.items():
    text(f"plan: {_name}", "plan.json", _content, "check FILE")
text("certificate: deep lists", "certificate.json", lambda: "[" * 10_000_000, "verify-certificate FILE")
text("certificate: a number", "certificate.json", lambda: DIGITS, "verify-certificate FILE")
text("batch: deep lists", "batch.json", lambda: "[" * 10_000_000, "batch FILE --out made")
text(
    "batch: items",
    "batch.json",
    lambda: json.dumps({"items": [{"plan": "x"}] * 3 + [{"plan": "y" * 10_000_000}]}),
    "batch FILE --out made --jobs 1",
)
