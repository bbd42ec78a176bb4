"""Writes sheets as SVG, PDF and DXF."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Sequence
from importlib.util import find_spec
from typing import Any, Final
from xml.sax.saxutils import escape

from articad.errors import ArticadError
from articad.kernels.views import Arc, Path2d, Segment
from articad.papers import EXTRA
from articad.papers.sheet import ARROW, HEIGHT_OF_CAPITALS, SMALL, STYLES, DrawingSheet, Lettering, text_width

__all__ = ["require_pdf", "written_dxf", "written_pdf", "written_svg"]

_POINT: Final = 72 / 25.4  # points of a PDF per mm
_CAP: Final = "round"


def require_pdf() -> None:
    """Check that PDF can be written.

    Raises:
        ArticadError: If reportlab is not installed.
    """
    if find_spec("reportlab") is None:
        raise ArticadError(f"PDF needs reportlab, which is not installed. Run: {EXTRA}; or write SVG or DXF.", stage="export")


def written_svg(sheet: DrawingSheet) -> bytes:
    """Return a sheet as SVG 1.1 of its true size."""
    (width, height), (strokes, arrows, texts) = sheet.size, sheet.everything()
    rows = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm" viewBox="0 0 {width:g} {height:g}">',
        f'<rect width="{width:g}" height="{height:g}" fill="#ffffff"/>',
    ]
    rows += [
        f'<image x="{_n(p.x)}" y="{_n(height - p.y - p.height)}" width="{_n(p.width)}" height="{_n(p.height)}" '
        f'href="data:image/png;base64,{base64.b64encode(p.png).decode("ascii")}"/>'
        for p in sheet.pictures
    ]
    for style, (thick, dashes) in STYLES.items():
        paths = " ".join(_path(stroke.line, height) for stroke in strokes if stroke.style == style)
        if paths:
            dashed = f' stroke-dasharray="{" ".join(f"{length:g}" for length in dashes)}"' if dashes else ""
            rows.append(
                f'<path class="{style}" fill="none" stroke="#000" stroke-width="{thick:g}" stroke-linecap="{_CAP if not dashes else "butt"}" '
                f'stroke-linejoin="round"{dashed} d="{paths}"/>'
            )
    filled = " ".join("M" + "L".join(f"{_n(x)} {_n(height - y)}" for x, y in corners) + "Z" for corners in arrows)
    if filled:
        rows.append(f'<path fill="#000" d="{filled}"/>')
    rows.append('<g font-family="Helvetica, Arial, \'Liberation Sans\', sans-serif" fill="#000">')
    for text in texts:
        turn = f' transform="rotate(-90 {_n(text.x)} {_n(height - text.y)})"' if text.turned else ""
        bold = ' font-weight="bold"' if text.bold else ""
        rows.append(
            f'<text x="{_n(text.x)}" y="{_n(height - text.y)}" font-size="{_n(text.height / HEIGHT_OF_CAPITALS)}" text-anchor="{text.anchor}"{bold}{turn} '
            f'textLength="{_n(text_width(text.words, text.height))}" lengthAdjust="spacingAndGlyphs">{escape(text.words)}</text>'
        )
    return "\n".join([*rows, "</g></svg>", ""]).encode()


def written_pdf(sheets: Sequence[DrawingSheet], title: str) -> bytes:
    """Return sheets as the pages of one PDF.

    Raises:
        ArticadError: If reportlab is not installed.
    """
    require_pdf()
    from reportlab.lib.utils import ImageReader  # noqa: PLC0415 - as below
    from reportlab.pdfgen.canvas import Canvas  # noqa: PLC0415 - an extra

    stream = io.BytesIO()
    canvas = Canvas(stream, invariant=1, pageCompression=1)
    canvas.setTitle(title)
    canvas.setAuthor("articad")
    for sheet in sheets:
        canvas.setPageSize((sheet.size[0] * _POINT, sheet.size[1] * _POINT))
        canvas.scale(_POINT, _POINT)
        for shown in sheet.pictures:
            canvas.drawImage(ImageReader(io.BytesIO(shown.png)), shown.x, shown.y, shown.width, shown.height)
        strokes, arrows, texts = sheet.everything()
        for style, (thick, dashes) in STYLES.items():
            canvas.setLineWidth(thick)
            canvas.setLineCap(0 if dashes else 1)
            canvas.setLineJoin(1)
            canvas.setDash(*([list(dashes), 0] if dashes else []))
            for stroke in strokes:
                if stroke.style == style:
                    path = canvas.beginPath()
                    _trace(path, stroke.line)
                    canvas.drawPath(path)
        for corners in arrows:
            path = canvas.beginPath()
            path.moveTo(*corners[0])
            for corner in corners[1:]:
                path.lineTo(*corner)
            path.close()
            canvas.drawPath(path, stroke=0, fill=1)
        for text in texts:
            _print(canvas, text)
        canvas.showPage()
    canvas.save()
    return stream.getvalue()


def written_dxf(sheet: DrawingSheet) -> bytes:
    """Return a sheet as DXF R2010 in mm of the part: views are as large as the part, and the sheet is plotted at its scale.

    Linear dimensions are DIMENSION entities, which measure the part.
    """
    import ezdxf  # noqa: PLC0415 - takes half a second
    from ezdxf import colors  # noqa: PLC0415 - as above

    k = 1.0 / sheet.scale
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True  # equal content gives equal bytes
    try:
        document = ezdxf.new("R2010", units=4)
        document.header["$LTSCALE"] = k
        for style, (thick, dashes) in STYLES.items():
            if dashes:
                document.linetypes.add(
                    style.upper(), [sum(dashes), *(length if i % 2 == 0 else -length for i, length in enumerate(dashes))]
                )
            layer = document.layers.add(style.upper(), color=colors.WHITE, lineweight=round(thick * 100))
            layer.dxf.linetype = style.upper() if dashes else "CONTINUOUS"
        for name in ("TEXT", "DIMENSION"):
            document.layers.add(name, color=colors.WHITE, lineweight=18)
        document.styles.add("NOTE", font="arial.ttf")
        look = document.dimstyles.add("SHEET")
        look.dxf.dimtxt, look.dxf.dimasz, look.dxf.dimexo, look.dxf.dimexe = SMALL * k, ARROW * k, 1.0 * k, 1.5 * k
        look.dxf.dimgap, look.dxf.dimtad, look.dxf.dimdec, look.dxf.dimtxsty = 0.8 * k, 1, 4, "NOTE"
        look.dxf.dimtih, look.dxf.dimtoh = 0, 0
        space = document.modelspace()
        for stroke in sheet.strokes:
            _draw(space, stroke.line, k, {"layer": stroke.style.upper()})
        for corners in sheet.arrows:
            points = [tuple(k * float(value) for value in corner) for corner in corners]
            space.add_solid([*points[:3], points[2]], dxfattribs={"layer": "DIMENSION"})
        for text in sheet.texts:
            _letter(space, text, k)
        for one in sheet.dimensions:
            place = (k * one.at, 0.0) if one.vertical else (0.0, k * one.at)
            ends = sorted((one.start, one.end), key=lambda point: point[1 if one.vertical else 0])
            p1, p2 = ((k * x, k * y) for x, y in ends)
            override = {"dimtmove": 2} if one.outside is not None else {}
            location = None
            if one.outside is not None:
                along = k * (one.outside + 0.5 * text_width(one.words, SMALL))
                location = (k * (one.at - 2.2), along) if one.vertical else (along, k * (one.at + 2.2))
            made = space.add_linear_dim(
                base=place, p1=p1, p2=p2, angle=90 if one.vertical else 0, text=_coded(one.words), dimstyle="SHEET", location=location,
                override=override, dxfattribs={"layer": "DIMENSION"},
            )  # fmt: skip
            made.render()
            made.dimension.dxf.actual_measurement = one.value
        stream = io.StringIO()
        document.write(stream)
        return stream.getvalue().encode()
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _n(value: float) -> str:
    return f"{round(float(value), 4):g}" if abs(value) < 1e5 else f"{value:.3f}"


def _ends(arc: Arc) -> tuple[tuple[float, float], ...]:
    angles = (arc.start, 0.5 * (arc.start + arc.end), arc.end)
    return tuple((arc.x + arc.radius * math.cos(math.radians(a)), arc.y + arc.radius * math.sin(math.radians(a))) for a in angles)


def _path(line: Segment | Arc | Path2d, height: float) -> str:
    """Return a line as the data of an SVG path; y points down there."""
    if isinstance(line, Segment):
        return f"M{_n(line.x0)} {_n(height - line.y0)}L{_n(line.x1)} {_n(height - line.y1)}"
    if isinstance(line, Path2d):
        return "M" + "L".join(f"{_n(x)} {_n(height - y)}" for x, y in line.points)
    r = _n(line.radius)
    (x0, y0), *rest = _ends(line)
    return f"M{_n(x0)} {_n(height - y0)}" + "".join(f"A{r} {r} 0 0 0 {_n(x)} {_n(height - y)}" for x, y in rest)


def _trace(path: Any, line: Segment | Arc | Path2d) -> None:
    if isinstance(line, Segment):
        path.moveTo(line.x0, line.y0)
        path.lineTo(line.x1, line.y1)
    elif isinstance(line, Path2d):
        path.moveTo(*map(float, line.points[0]))
        for point in line.points[1:]:
            path.lineTo(*map(float, point))
    else:
        r = line.radius
        path.arc(line.x - r, line.y - r, line.x + r, line.y + r, startAng=line.start, extent=line.end - line.start)


def _print(canvas: Any, text: Lettering) -> None:
    canvas.saveState()
    canvas.translate(text.x, text.y)
    if text.turned:
        canvas.rotate(90)
    canvas.setFont("Helvetica-Bold" if text.bold else "Helvetica", text.height / HEIGHT_OF_CAPITALS)
    words = text.words.encode("cp1252", errors="replace").decode("cp1252")
    {"start": canvas.drawString, "middle": canvas.drawCentredString, "end": canvas.drawRightString}[text.anchor](0, 0, words)
    canvas.restoreState()


def _draw(space: Any, line: Segment | Arc | Path2d, k: float, attributes: dict[str, Any]) -> None:
    if isinstance(line, Segment):
        space.add_line((k * line.x0, k * line.y0), (k * line.x1, k * line.y1), dxfattribs=attributes)
    elif isinstance(line, Path2d):
        space.add_lwpolyline([(k * float(x), k * float(y)) for x, y in line.points], dxfattribs=attributes)
    elif line.end - line.start >= 360.0 - 1e-9:
        space.add_circle((k * line.x, k * line.y), k * line.radius, dxfattribs=attributes)
    else:
        space.add_arc((k * line.x, k * line.y), k * line.radius, line.start, line.end, dxfattribs=attributes)


def _letter(space: Any, text: Lettering, k: float) -> None:
    from ezdxf.enums import TextEntityAlignment  # noqa: PLC0415 - as above

    placed = space.add_text(
        _coded(text.words), height=k * text.height, rotation=90 if text.turned else 0, dxfattribs={"layer": "TEXT", "style": "NOTE"}
    )
    kind = {"start": TextEntityAlignment.LEFT, "middle": TextEntityAlignment.CENTER, "end": TextEntityAlignment.RIGHT}[text.anchor]
    placed.set_placement((k * text.x, k * text.y), align=kind)


def _coded(words: str) -> str:
    """Return a text with the codes that every reader of DXF knows."""
    return words.replace("Ø", "%%c").replace("±", "%%p").replace("°", "%%d")
