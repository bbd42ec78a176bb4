"""What differs between FreeCAD files of equal content: dates, people, Uids, order, and the last bits of numbers.

FreeCAD's sketch solver leaves coincident corners 1e-15 mm apart, differently in each process. Shapes are rounded to 12 decimals of a
millimetre, which is finer than their accuracy and makes equal files of equal parts.
"""

from __future__ import annotations

import io
import re
import uuid
import zipfile
from collections.abc import Mapping

from lxml import etree

EPOCH = "2000-01-01T00:00:00Z"
DIGITS = 12  # decimals of mm kept of a shape
# Both match a number from its first digit only; matching from every digit of a long number would take time quadratic in its length.
_NUMBER = re.compile(rb"(?<!\d)-?\d+(?:\.\d+)?e[+-]?\d+|(?<!\d)-?\d+\.\d{%d,}" % (DIGITS + 1))
_LONG = re.compile(rb"(?<!\d)-?\d{30,}\.\d+")  # FreeCAD writes 2e100, where a surface has no end, with all its digits
ENDLESS = 1e99  # from here on a bound of a surface or curve is OCCT's infinity, 2e100
# The row of a trimmed surface (type 10) or curve (type 8): its bounds alone; what it trims follows on the next row.
_TRIMMED = re.compile(rb"^(?:10((?: +[-+.\de]+){4})|8((?: +[-+.\de]+){2})) *\n", re.MULTILINE)
_ZIP_TIME = (2000, 1, 1, 0, 0, 0)
_NAMESPACE = uuid.UUID("6d1d9a3e-0c1b-5b6e-9b35-0a2f4f1c7c11")  # for the Uids that replace random ones
_DATES = {"CreationDate", "LastModifiedDate"}
_PEOPLE = {"CreatedBy", "LastModifiedBy", "Company"}


def rounded(brep: bytes) -> bytes:
    """Return a B-rep as text with its numbers rounded to 12 decimals."""
    return _NUMBER.sub(lambda number: b"%r" % (round(float(number[0]), DIGITS) + 0.0), brep)


def shortened(brep: bytes) -> bytes:
    """Return a B-rep as text without numbers so long that OCCT 7.9 overruns its buffer when it reads them."""
    return _LONG.sub(lambda number: b"%r" % float(number[0]), brep)


def bounded(brep: bytes) -> bytes:
    """Return a B-rep as text without trimmed surfaces and curves that have no end.

    OCCT trims a surface without an end at 2e100, and FreeCAD writes such a bound with all of its 101 digits. FreeCAD 1.1 then
    loses the shape, or crashes. A trimmed surface has the parametrisation of the surface that it trims, so the latter takes its
    place: faces are bounded by their edges, which stay as they are.
    """
    return _TRIMMED.sub(lambda row: b"" if any(abs(float(number)) >= ENDLESS for number in (row[1] or row[2]).split()) else row[0], brep)


def settled(content: bytes) -> bytes:
    """Return a part's document in reproducible form: no date, no random Uid, shapes to 12 decimals."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    root = etree.fromstring(files["Document.xml"], xml_parser())
    settle(root)
    files["Document.xml"] = etree.tostring(root, xml_declaration=True, encoding="utf-8", standalone=False)
    return packed({name: rounded(bounded(data)) if name.endswith(".brp") else data for name, data in files.items()})


def packed(files: Mapping[str, bytes]) -> bytes:
    """Return a zip of files, all with the same date, in the order in which FreeCAD reads them.

    Document.xml comes first and GuiDocument.xml after all shapes: FreeCAD reads forwards only, and with GuiDocument.xml before them
    every shape stays empty if there is a display.
    """
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        ends = ("Document.xml", "GuiDocument.xml")
        order = ["Document.xml", *(name for name in files if name not in ends), *(name for name in ends[1:] if name in files)]
        for name in order:
            entry = zipfile.ZipInfo(name, _ZIP_TIME)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, files[name])
    return stream.getvalue()


def xml_parser() -> etree.XMLParser:
    """Return a parser that resolves and fetches nothing."""
    return etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=True)


def settle(root: etree._Element) -> None:
    """Replace what differs between runs: dates, people, Uids, paths."""
    for name in _DATES | _PEOPLE | {"TransientDir", "FileName"}:
        for text in root.iterfind(f"Properties/Property[@name='{name}']/String"):
            text.set("value", EPOCH if name in _DATES else "")
    for number, uid in enumerate(root.iter("Uuid")):
        uid.set("value", str(uuid.uuid5(_NAMESPACE, str(number))))
    for item in root.iterfind("Objects/Object[@Touched]"):
        del item.attrib["Touched"]
    for needs in root.iter("ObjectDeps"):  # FreeCAD orders them by address
        needs[:] = sorted(needs, key=lambda need: need.get("Name"))
        for need in needs:
            need.tail = needs.text
