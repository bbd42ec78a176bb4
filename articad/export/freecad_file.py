"""Makes a FreeCAD file reproducible, and visible when opened.

FreeCAD without a display writes no GuiDocument.xml, so everything would be hidden when opened, and joints would lack their icons. It
also writes dates, a random Uid and the user's name. All of this is corrected here in the file, which is a zip of XML and B-rep.
"""

from __future__ import annotations

import io
import re
import struct
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from xml.sax.saxutils import quoteattr

import numpy as np
from lxml import etree

from articad.export.freecad_content import PROPERTY, Content, content_of, packed_content
from articad.geometry.mesh import TriMesh
from articad.kernels.freecad_file import bounded, packed, settle, xml_parser

_LETTERS = 3.5  # mm, of the texts of drawings
_NOTHING = "bnVsbA=="  # base64 of null: FreeCAD's own entry for a view provider without state
_SHOWN = (  # besides parts and assemblies, objects with a shape of their own
    "PartDesign::Body",
    "Part::Feature",
    "Part::Mirroring",
    "Mesh::Feature",
)
_MESH_HEADER = struct.pack("<II", 0xA0B0C0D0, 0x010000) + b"MESH-" * 51 + b"\n"  # FreeCAD's own header, before the counts
_NO_FACET = 0xFFFFFFFF  # marks an edge of only one facet
_GROUPS = ("App::Part", "App::Link", "Assembly::AssemblyObject", "Assembly::JointGroup", "Assembly::BomGroup", "Assembly::BomObject")


@dataclass(frozen=True)
class Appearance:
    """The appearance of a document when it is opened.

    Attributes:
        colors: "#rrggbb" by object.
        hidden: Objects that are hidden although their type is shown.
        joints: Objects that are joints.
        grounded: The object that grounds a part, if any.
        tips: Features that their bodies show.
        views: Classes of the view providers of an exploded view and its moves.
    """

    colors: Mapping[str, str] = field(default_factory=dict)
    hidden: Sequence[str] = ()
    joints: Sequence[str] = ()
    grounded: str | None = None
    tips: Sequence[str] = ()
    views: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def out_of_sight(self) -> frozenset[str]:
        """The objects that are hidden, for a look at each object."""
        return frozenset(self.hidden)

    @cached_property
    def moving(self) -> frozenset[str]:
        """The objects that are joints, likewise."""
        return frozenset(self.joints)

    @cached_property
    def named(self) -> frozenset[str]:
        """The objects that are shown whatever their type."""
        return frozenset((*self.joints, *self.tips, *([] if self.grounded is None else [self.grounded])))


def normalised(content: bytes, look: Appearance | None = None, written: Content | None = None) -> bytes:
    """Return a FreeCAD file with fixed dates, Uids and order, and with its appearance.

    Args:
        content: The file as FreeCAD wrote it.
        look: Its appearance; None omits GuiDocument.xml.
        written: The content that its assembly stores; by default that of this file.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if name not in ("GuiDocument.xml", "thumbnails/Thumbnail.png")}
    root = etree.fromstring(files["Document.xml"], xml_parser())
    settle(root)
    _carry(root, content_of(root) if written is None else written)
    types = {item.get("name"): item.get("type") for item in root.iterfind("Objects/Object")}
    if look is not None:
        _show(root, types, look)
        files["GuiDocument.xml"] = _gui(types, look)
    files["Document.xml"] = etree.tostring(root, xml_declaration=True, encoding="utf-8", standalone=False)
    return packed({name: bounded(data) if name.endswith(".brp") else data for name, data in files.items()})


def _carry(root: etree._Element, written: Content) -> None:
    """Store the content of the document in its assembly, so that the reader can find edits."""
    content = packed_content(written)
    for row in root.iterfind(f"ObjectData/Object/Properties/Property[@name='{PROPERTY}']/String"):
        row.set("value", content)


def _is_shown(name: str, kind: str, look: Appearance) -> bool:
    if name in look.out_of_sight:
        return False
    if kind.startswith("TechDraw::"):
        return kind != "TechDraw::DrawPage"  # a page that is shown opens its tab with the document
    return kind in _SHOWN or kind in _GROUPS or name in look.named


def _show(root: etree._Element, types: Mapping[str, str], look: Appearance) -> None:
    """Set the Visibility that objects store besides their view providers."""
    for item in root.iterfind("ObjectData/Object"):
        name = item.get("name")
        for flag in item.iterfind("Properties/Property[@name='Visibility']/Bool"):
            flag.set("value", "true" if _is_shown(name, types.get(name, ""), look) else "false")


def _gui(types: Mapping[str, str], look: Appearance) -> bytes:
    providers = [_provider(name, kind, look) for name, kind in types.items()]
    lines = [
        "<?xml version='1.0' encoding='utf-8'?>",
        "<!--\n FreeCAD Document, see https://www.freecad.org for more information...\n-->",
        '<Document SchemaVersion="1" HasExpansion="1">',
        f'    <Expand count="1">\n        <Expand name="{next((n for n, k in types.items() if k == "Assembly::AssemblyObject"), "")}"/>\n    </Expand>',
        f'    <ViewProviderData Count="{len(providers)}">',
        *providers,
        "    </ViewProviderData>",
        '    <Camera settings="  OrthographicCamera { viewportMapping ADJUST_CAMERA orientation 0.74290609 0.30772209 0.59447283 1.2171158 }"/>',
        "</Document>",
    ]
    return "\n".join(lines).encode() + b"\n"


def _provider(name: str, kind: str, look: Appearance) -> str:
    shown = "true" if _is_shown(name, kind, look) else "false"
    properties = [f'<Property name="Visibility" type="App::PropertyBool"><Bool value="{shown}"/></Property>']
    if name in look.colors:
        red, green, blue = (int(look.colors[name][start : start + 2], 16) for start in (1, 3, 5))
        packed_color = (red << 24 | green << 16 | blue << 8) & 0xFFFFFFFF
        properties += _link_color(packed_color) if kind == "App::Link" else []
        properties.append(f'<Property name="ShapeColor" type="App::PropertyColor"><PropertyColor value="{packed_color}"/></Property>')
    if name in look.moving or name == look.grounded:
        provider = "ViewProviderGroundedJoint" if name == look.grounded else "ViewProviderJoint"
        proxy = f'<Python value="{_NOTHING}" encoded="yes" module="JointObject" class="{provider}"/>'
        properties.append(f'<Property name="Proxy" type="App::PropertyPythonObject">{proxy}</Property>')
    if kind in ("TechDraw::DrawViewDimension", "TechDraw::DrawViewBalloon"):
        properties.append(f'<Property name="Fontsize" type="App::PropertyLength"><Float value="{_LETTERS}"/></Property>')
    if name in look.views:
        proxy = f'<Python value="{_NOTHING}" encoded="yes" module="CommandCreateView" class="{look.views[name]}"/>'
        properties.append(f'<Property name="Proxy" type="App::PropertyPythonObject">{proxy}</Property>')
    inner = "".join(f"\n                {line}" for line in properties)
    expanded = "1" if kind in ("Assembly::AssemblyObject", "Assembly::JointGroup") else "0"
    return (
        f'        <ViewProvider name={quoteattr(name)} expanded="{expanded}">\n'
        f'            <Properties Count="{len(properties)}" TransientCount="0">{inner}\n            </Properties>\n        </ViewProvider>'
    )


def _link_color(packed_color: int) -> list[str]:
    """Return the properties that give a link a colour of its own in place of its object's."""
    colors = f'ambientColor="1431655680" diffuseColor="{packed_color}" specularColor="2290649088" emissiveColor="0"'
    return [
        '<Property name="OverrideMaterial" type="App::PropertyBool"><Bool value="true"/></Property>',
        f'<Property name="ShapeMaterial" type="App::PropertyMaterial"><PropertyMaterial {colors} shininess="0.9" transparency="0"/></Property>',
    ]


def python_classes(content: bytes) -> set[str]:
    """Return the Python classes that opening a FreeCAD file would instantiate."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        document = archive.read("Document.xml").decode(errors="replace")
    return {f"{module}.{name}" for module, name in re.findall(r'<Python [^>]*module="([^"]*)"[^>]*class="([^"]*)"', document)}


def mesh_kernel(mesh: TriMesh) -> bytes:
    """Return a mesh in FreeCAD's format: points, and for each facet its points and its neighbours."""
    points, index = np.unique(mesh.vertices.astype("<f4") + np.float32(0.0), axis=0, return_inverse=True)
    facets = index.reshape(-1)[mesh.triangles].astype("<u4")
    beside = np.full(facets.shape, _NO_FACET, dtype="<u4")
    waiting: dict[tuple[int, int], tuple[int, int]] = {}
    for place, (a, b) in enumerate(np.stack([facets, np.roll(facets, -1, axis=1)], axis=2).reshape(-1, 2).tolist()):
        here = divmod(place, 3)
        there = waiting.pop((min(a, b), max(a, b)), None)
        if there is None:
            waiting[min(a, b), max(a, b)] = here
        else:
            beside[here], beside[there] = there[0], here[0]
    bounds = np.stack([points.min(axis=0), points.max(axis=0)], axis=1) if len(points) else np.zeros((3, 2), dtype="<f4")
    counts = struct.pack("<II", len(points), len(facets))
    return _MESH_HEADER + counts + points.tobytes() + np.hstack([facets, beside]).tobytes() + bounds.astype("<f4").tobytes()
