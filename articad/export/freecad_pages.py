"""What the drawings of an assembly show: pages of parts and of the assembly, and the moves of an exploded view.

Sizes and places are computed here; FreeCAD draws them (`kernels/inside_freecad/drawings.py`). Lengths on a page are in mm from its lower left
corner. Views follow first-angle projection (ISO 5456-2): the top view is below the front view, the view from the left to its right.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from articad.aliases import Json
from articad.geometry.part import Part
from articad.kinematics.joints import JointType

if TYPE_CHECKING:
    from articad.assembly import Assembly

SCALES = (50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)  # ISO 5455
A4, A3 = (297.0, 210.0), (420.0, 297.0)
_MARGIN, _LEFT, _GAP, _BLOCK = 10.0, 42.0, 32.0, (122.0, 36.0)  # frame; space for dimensions; between views; title block
_LETTER, _DIGITS = 2.1, 7  # mean width of a letter of a dimension [mm]; letters of a number with its sign
_ROUND = re.compile(r"radius|diameter")
Boxes = dict[str, NDArray[np.float64]]
_NAMESPACE = "https://www.freecad.org/wiki/index.php?title=Svg_Namespace"  # of the texts that FreeCAD can edit
_AXES = {  # view -> what points right and up on the page
    "front": ((1, 0, 0), (0, 0, 1)),
    "top": ((1, 0, 0), (0, 1, 0)),
    "left": ((0, -1, 0), (0, 0, 1)),
}
_LINE = 8.0  # height of a row of a parts list
_APART = 1.15  # of its length along a direction, by which a part leaves its neighbour in the exploded view
_ALONG = (JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL, JointType.SCREW, JointType.FIXED, JointType.PLANAR)


def drawings(assembly: Assembly, job: Json) -> Json:
    """Return the pages and the moves, for the program that makes them in FreeCAD.

    Args:
        assembly: The assembly.
        job: The content of its document; see `freecad_job.Job`.
    """
    drawn = [row for row in job["parts"] if row["kind"] in ("body", "shape", "mirror") and assembly.parts[row["name"]].solid is not None]
    count, boxes = len(drawn) + 1, _boxes(assembly)
    pages = [_page(assembly, row, f"{number} / {count}") for number, row in enumerate(drawn, start=2)]
    return {
        "assembly": _assembly_page(assembly, boxes, job, f"1 / {count}"),
        "parts": pages,
        "moves": list(_moves(assembly, boxes)),
    }


def _page(assembly: Assembly, row: Json, sheet: str) -> Json:
    """Return the page of one part: three views, an isometric one, and a title block."""
    part = assembly.parts[row["name"]]
    if part.solid is None:
        raise AssertionError("a page shows a solid")
    width, depth, height = (float(size) for size in part.solid.bbox[1] - part.solid.bbox[0])
    labels = max((len(item["name"]) + _DIGITS for item in row["dimensions"] if _ROUND.search(item["name"])), default=0)
    gap = max(_GAP, 16.0 + _LETTER * labels)  # labels of circles are at the right of their views
    room = (A4[0] - 2 * _MARGIN - _LEFT - gap - 12.0, A4[1] - 2 * _MARGIN - _BLOCK[1] - _GAP - 10.0)
    scale = next((s for s in SCALES if (width + depth) * s <= room[0] and (height + depth) * s <= room[1]), SCALES[-1])
    w, d, h = width * scale, depth * scale, height * scale
    x, y = _MARGIN + _LEFT + w / 2, A4[1] - _MARGIN - 8.0 - h / 2
    aside, below = x + w / 2 + gap + d / 2, y - h / 2 - _GAP + 4.0 - d / 2
    places = {"front": (x, y), "left": (aside, y), "top": (x, below)}
    free = A4[0] - _MARGIN - (x + w / 2) - gap
    across, tall = 0.7071 * (width + depth), 0.8165 * height + 0.4082 * (width + depth)
    small = next((s for s in SCALES if s <= scale and across * s <= free and tall * s <= max(d, 30.0)), SCALES[-1])
    views = [{"name": name, "x": at[0], "y": at[1], "scale": scale, **_seen(name)} for name, at in places.items()]
    seat = (x + w / 2 + gap + free / 2, max(below, _MARGIN + _BLOCK[1] + 4.0 + tall * small / 2))
    views.append({"name": "iso", "x": seat[0], "y": seat[1], "scale": small, "direction": [-1, -1, 1], "right": [1, -1, 0]})
    overall = " × ".join(f"{size:.5g}" for size in (width, depth, height))
    fields = _fields(assembly, row["name"], sheet, scale) | {"Material": part.material or "-", "Mass": _mass(part), "Overall": overall}
    told = [f"{item['name']} = {item['value']:.6g}" for item in row["dimensions"]]
    return {
        "part": row["name"],
        "label": f"Drawing of {row['name']}",
        "template": _template(A4, fields),
        "views": views,
        "size": [width, depth, height],
        "letter": _LETTER,
        "dimensions": {item["name"]: item["value"] for item in row["dimensions"]},
        "note": ["Dimensions of the plan:", *_columns(told, 3)] if told else [],
        "note_at": [_MARGIN + 76.0, _MARGIN + 18.0],
    }


def _columns(texts: list[str], count: int) -> list[str]:
    """Return texts in rows of a few."""
    return [", ".join(texts[start : start + count]) for start in range(0, len(texts), count)]


def _seen(name: str) -> Json:
    right, up = _AXES[name]
    return {"direction": np.cross(right, up).tolist(), "right": list(right), "up": list(up)}


def _assembly_page(assembly: Assembly, boxes: Boxes, job: Json, sheet: str) -> Json:
    """Return the page of the assembly: an isometric view with balloons, and the list of parts."""
    low, high = np.min([box[0] for box in boxes.values()], axis=0), np.max([box[1] for box in boxes.values()], axis=0)
    width, depth, height = (float(size) for size in high - low)
    across, tall = 0.7071 * (width + depth), 0.8165 * height + 0.4082 * (width + depth)
    scale = next((s for s in SCALES if across * s <= 170.0 and tall * s <= 190.0), SCALES[-1])
    masses = [part.mass.mass for part in assembly.parts.values() if part.mass is not None]
    fields = _fields(assembly, assembly.name, sheet, scale) | {
        "Material": f"{len(assembly.parts)} parts",
        "Mass": f"{sum(masses):.4g} kg" if masses else "-",
        "Overall": " × ".join(f"{size:.5g}" for size in (width, depth, height)),
    }
    bodies = [row for row in job["parts"] if row["kind"] != "link"]
    return {
        "label": f"Drawing of {assembly.name}",
        "template": _template(A3, fields),
        "view": {"x": 125.0, "y": 155.0, "scale": scale, "direction": [-1, -1, 1], "right": [1, -1, 0]},
        "balloons": {row["name"]: np.mean(boxes[row["name"]], axis=0).tolist() for row in bodies},
        "radius": [0.5 * across * scale + 18.0, 0.5 * tall * scale + 14.0],
        "list": {"x": 320.0, "y": A3[1] - _MARGIN - 2.0 - 0.5 * (len(bodies) + 1) * _LINE},
    }


def _fields(assembly: Assembly, title: str, sheet: str, scale: float) -> dict[str, str]:
    ratio = f"{scale:g} : 1" if scale >= 1 else f"1 : {1 / scale:g}"
    return {"Title": title, "Assembly": assembly.name, "Scale": ratio, "Sheet": sheet}


def _mass(part: Part) -> str:
    return "-" if part.mass is None else f"{part.mass.mass:.4g} kg"


def _template(size: tuple[float, float], fields: dict[str, str]) -> str:
    """Return a page with a frame and a title block (ISO 7200), as SVG. FreeCAD can edit the texts."""
    (width, height), (wide, tall) = size, _BLOCK
    left, top = width - _MARGIN - wide, height - _MARGIN - tall
    cells = (  # what, left, top, width: rows of 12 mm
        ("Title", 0.0, 0.0, 82.0),
        ("Sheet", 82.0, 0.0, 40.0),
        ("Assembly", 0.0, 12.0, 62.0),
        ("Overall", 62.0, 12.0, 60.0),
        ("Material", 0.0, 24.0, 52.0),
        ("Mass", 52.0, 24.0, 30.0),
        ("Scale", 82.0, 24.0, 40.0),
    )
    names = {"Overall": "Overall, mm", "Scale": "Scale; first angle"}
    rows = [
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:freecad="{_NAMESPACE}" width="{width:g}mm" height="{height:g}mm" viewBox="0 0 {width:g} {height:g}">',
        '<g fill="none" stroke="#000000" stroke-width="0.5">',
        f'<rect x="{_MARGIN:g}" y="{_MARGIN:g}" width="{width - 2 * _MARGIN:g}" height="{height - 2 * _MARGIN:g}"/>',
        *(f'<rect x="{left + x:g}" y="{top + y:g}" width="{w:g}" height="12"/>' for _, x, y, w in cells),
        '</g><g fill="#000000" stroke="none" font-family="osifont, sans-serif">',
    ]
    for name, x, y, _ in cells:
        rows.append(f'<text x="{left + x + 1.5:g}" y="{top + y + 3.6:g}" font-size="2.5">{escape(names.get(name, name))}</text>')
        rows.append(
            f'<text freecad:editable={quoteattr(name)} x="{left + x + 1.5:g}" y="{top + y + 9.6:g}" font-size="4.2">'
            f"<tspan>{escape(fields[name])}</tspan></text>"
        )
    return "\n".join([*rows, "</g></svg>", ""])


# ---------------------------------------------------------------------- the exploded view


def _moves(assembly: Assembly, boxes: Boxes) -> Iterator[Json]:
    """Yield the moves, from the ground outwards: along its joint, each part with all that it carries leaves the part that carries it."""
    poses = assembly.at()
    carried: dict[str, list[str]] = {name: [] for name in assembly.parts}
    order: list[tuple[str, str, NDArray[np.float64]]] = []
    reached = [assembly.ground]
    for parent in reached:
        for joint in assembly.joints:
            ends = (joint.parent, joint.child)
            if parent not in ends or joint.type is JointType.FREE:
                continue
            child = ends[1] if parent == ends[0] else ends[0]
            if child in reached:
                continue
            axis = (poses[joint.parent] @ joint.T_parent_connector).rotation[:, 2]
            reached.append(child)
            carried[parent].append(child)
            order.append((parent, child, axis if joint.type in _ALONG else np.zeros(3)))
    for parent, child, axis in order:
        away = np.mean(boxes[child], axis=0) - np.mean(boxes[parent], axis=0)
        away = away if np.linalg.norm(away) > 1e-9 else np.array([0.0, 0.0, 1.0])
        direction = axis * (1.0 if axis @ away >= 0 else -1.0) if axis.any() else away / np.linalg.norm(away)
        lengths = [float(np.abs(direction) @ (boxes[name][1] - boxes[name][0])) for name in (child, parent)]
        far = _APART * lengths[0] + 0.5 * min(lengths)
        yield {"part": child, "parts": list(_carried(child, carried)), "by": (direction * far).tolist()}


def _carried(name: str, carried: dict[str, list[str]]) -> Iterator[str]:
    waiting = [name]
    while waiting:
        found = waiting.pop()
        yield found
        waiting += carried[found]


def _boxes(assembly: Assembly) -> Boxes:
    """Return the corners of the box around each part at rest `(2, 3)` [mm]."""
    found = {}
    for name, T in assembly.at().items():
        part = assembly.parts[name]
        local = np.zeros((2, 3))
        if part.solid is not None:
            local = np.asarray(part.solid.bbox)
        elif part.mesh is not None:
            local = np.stack([part.mesh.vertices.min(axis=0), part.mesh.vertices.max(axis=0)])
        corners = np.array([[local[i][0], local[j][1], local[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        placed = corners @ T.rotation.T + T.translation
        found[name] = np.stack([placed.min(axis=0), placed.max(axis=0)])
    return found
