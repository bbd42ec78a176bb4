"""Feature trees of parts whose scripts are written in build123d.

The script runs once more in the worker's sandbox, with its dimensions as traced numbers, and reports its operations with their formulas.
FreeCAD makes them as features of its Part workbench whose properties follow the dimensions. Then measurement decides: all dimensions are
changed together in three ways, each count is changed alone, and so is each other dimension while time allows, in FreeCAD and in the
script. A dimension whose changes do not give the same solid in both is
fixed in the tree. A tree that is not the part's solid to begin with is none. Trees are cached by script, dimensions and versions.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from articad.aliases import Json
from articad.connectors.se3 import SE3
from articad.files import UnsafeFileError, read_left
from articad.findings import Finding
from articad.kernels.build123d import Build123dKernel
from articad.kernels.cache import BuildCache
from articad.kernels.contract import primary_connector, read_connectors, seating
from articad.kernels.failures import scrubbed
from articad.kernels.freecad_file import settled
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.kernels.kernel import SEATED_MM, SEATED_RAD, BuiltPart
from articad.kernels.results import PoisonedError, number, numbers
from articad.kernels.tree_objects import tree_objects
from articad.plan.resolve import ResolvedPart

__all__ = ["PartTree", "part_tree"]

RECIPE: Final = 4  # increased when trees are made or judged differently, so that cached ones are made again
SAME: Final = 1e-6  # relative difference of volumes, areas and inertias; of centres in terms of the part's size
MAX_TREE_BYTES: Final = 64 * 2**20
_REPORT_BYTES: Final = 16 * 2**20
_UNITS: Final = {"mm³": "mm3", "mm²": "mm2", "mm": "mm", "mm⁵": "mm5"}
_PROGRAM: Final = Path(__file__).parent / "inside_freecad" / "tree.py"
_SECONDS: Final = 240.0
_ALONE: Final = 12  # dimensions that are changed alone, besides counts; all are changed together
_STEPS: Final = ((-0.05, -0.02, -0.004), (0.07, 0.02, 0.004))  # relative changes down and up, the first that the script builds
_ZERO_STEPS: Final = ((0.5, 0.1), (0.7, 0.1))  # changes of a dimension that is zero [mm, deg]


@dataclass(frozen=True)
class PartTree:
    """The feature tree of a part, or why it has none.

    Attributes:
        document: The FreeCAD document with one PartDesign::Body and its VarSet; None if the part has no tree.
        reason: Why it has none.
        fixed: Why a dimension cannot be edited in the tree, by dimension.
        seat: Pose of the document's body in the part's frame.
    """

    document: Path | None
    reason: str = ""
    fixed: Mapping[str, str] = field(default_factory=dict)
    seat: SE3 = field(default_factory=SE3.identity)


def part_tree(
    target: ResolvedPart, built: BuiltPart, script: bytes, *, kernel: Build123dKernel, freecad: FreeCAD, cache: BuildCache
) -> PartTree:
    """Return the feature tree of a part that a build123d script built; from the cache if it is there.

    Args:
        target: The part in the plan.
        built: The part as the script built it, seated in the plan.
        script: The script.
        kernel: Runs the script.
        freecad: Makes the tree.
        cache: Stores it.

    Raises:
        KernelError: If no script can be run here.
    """
    held = json.dumps([dict(built.brief), kernel.version, freecad.version_text, RECIPE], sort_keys=True)
    digest = f"tree-{hashlib.sha256(held.encode() + script).hexdigest()}"
    folder = cache.get(digest)
    if folder is None:
        with cache.writing(digest) as empty:
            told = _Maker(kernel, freecad, script, built.brief, empty).told()
            (empty / "tree.json").write_text(json.dumps(told))
        folder = cache.root / digest
    told = json.loads((folder / "tree.json").read_text())
    if told["reason"]:
        return PartTree(None, told["reason"])
    ignored: list[Finding] = []
    connectors = read_connectors(built.brief, told["connectors"], ignored)
    seat = seating(target, connectors, primary_connector(target, dict(built.brief)))
    seat = SE3.identity() if seat.allclose(SE3.identity(), mm=SEATED_MM, rad=SEATED_RAD) else seat
    solid, center = built.solid, seat.apply(np.array(told["nominal"]["com_mm"]))
    size = float(np.linalg.norm(solid.bbox[1] - solid.bbox[0]))
    if abs(told["nominal"]["volume_mm3"] / solid.volume - 1) > SAME or float(np.abs(center - solid.com).max()) > SAME * size:
        return PartTree(None, "its features give another solid than the part's")
    return PartTree(folder / "part.FCStd", fixed=told["fixed"], seat=seat)


class _Maker:
    """Makes and judges one tree in an empty folder."""

    def __init__(self, kernel: Build123dKernel, freecad: FreeCAD, script: bytes, brief: Mapping[str, Any], folder: Path) -> None:
        self._kernel, self._freecad, self._folder = kernel, freecad, folder
        self._source, self._brief = script.decode("utf-8", errors="replace"), dict(brief)
        self._dimensions: dict[str, float] = self._brief["dimensions"]

    def told(self) -> Json:
        """Return what is to be known about the tree: the reason why there is none, or its fixed dimensions and its measures."""
        try:
            return self._judged()
        except NoTreeError as none:
            return {"reason": str(none), "fixed": {}}
        except PoisonedError as poison:
            return {"reason": f"its script cannot be traced: {poison}", "fixed": {}}

    def _judged(self) -> Json:
        counts = [name for name, value in self._dimensions.items() if isinstance(value, int)]
        free = [name for name in self._dimensions if name not in counts]
        owners = [*counts, *free[:_ALONE]]
        alone = [_moves(name, self._dimensions[name], up=place % 2 == 0) for place, name in enumerate(owners)]
        together = self._together(free)
        tried = [*together, *([{**self._dimensions, name: value} for value in values] for name, values in zip(owners, alone, strict=True))]
        trace, script = self._traced(tried)
        connectors = self._connectors(trace)
        made, nominal, varied = self._in_freecad(trace, script)
        if wrong := _difference(nominal, script[0], nominal, script[0]):
            raise NoTreeError(f"its features give another solid: {wrong}")
        fixed: dict[str, str] = {}
        for owner, mine, theirs in zip(owners, varied[len(together) :], script[1 + len(together) :], strict=True):
            if not theirs["ok"]:
                fixed[owner] = "the script builds no part with another value near it"
            elif wrong := _difference(mine, theirs, nominal, script[0]):
                fixed[owner] = self._why(owner, wrong)
        if set(fixed) == set(self._dimensions) and fixed:
            raise NoTreeError(f"its features follow no dimension: {next(iter(fixed.values()))}")
        live = [name for name in free if name not in fixed]
        if live != free:
            together = self._together(live)
            trace, script = self._traced(together)
            made, nominal, varied = self._in_freecad(trace, script)
        for mine, theirs in zip(varied[: len(together)], script[1 : 1 + len(together)], strict=True):
            if theirs["ok"] and (wrong := _difference(mine, theirs, nominal, script[0])):
                raise NoTreeError(f"its features do not follow several dimensions at once: {wrong}")
        (self._folder / "part.FCStd").write_bytes(settled(made))
        return {"reason": "", "fixed": fixed, "connectors": connectors, "nominal": nominal}

    def _why(self, dimension: str, wrong: str) -> str:
        if isinstance(self._dimensions[dimension], int):
            return "the tree has as many features as the script made for this count"
        return f"FreeCAD and the script differ when it changes ({wrong})"

    def _together(self, names: list[str]) -> list[list[Json]]:
        """Return the dimensions with all of some changed at once: all up, all down, and every second one."""
        if len(names) < 2:
            return []
        signs = ([1.0] * len(names), [-1.0] * len(names), [(-1.0) ** place for place in range(len(names))])
        return [
            [
                {
                    **self._dimensions,
                    **{
                        name: _moved(self._dimensions[name], step if sign > 0 else -0.8 * step)
                        for name, sign in zip(names, row, strict=True)
                    },
                }
                for step in (0.06, 0.01, 0.002)
            ]
            for row in signs
        ]

    def _traced(self, tried: list[list[Json]]) -> tuple[Json, list[Json]]:
        """Return the trace, and the solid's measures: first unchanged, then at the first buildable of each list of dimensions."""
        limits = replace(self._kernel.limits, seconds=self._kernel.limits.seconds + self._kernel.limits.probe_seconds, probe_seconds=0.0)
        variations = [[self._dimensions], *tried]
        job = {"script": self._source, "part": self._brief, "variations": variations}
        lines = self._kernel.run_task("trace", job, limits)
        if not lines:
            raise NoTreeError("its script ends the process when it is traced")
        if lines[0].get("ok") is not True:
            reason = lines[0].get("reason")
            raise NoTreeError(scrubbed(reason, 300) if isinstance(reason, str) else "its script cannot be traced")
        if len(lines) != len(tried) + 2:
            raise NoTreeError("its script takes too long to be run at other dimensions")
        measured = [_measures(line) for line in lines[1:]]
        for line, options in zip(measured, variations, strict=True):
            if line["ok"]:
                if line["choice"] >= len(options):
                    raise PoisonedError("a measure belongs to dimensions that were not asked for")
                line["dimensions"] = options[line["choice"]]
        if not measured[0]["ok"]:
            raise NoTreeError("its script builds no valid solid")
        return lines[0], measured

    def _connectors(self, trace: Json) -> Json:
        """Return the planned connectors of a trace, each with three numbers for every axis that it states.

        Raises:
            PoisonedError: If they have another form.
        """
        told: Any = trace.get("connectors")
        ignored: list[Finding] = []
        names = read_connectors(self._brief, told, ignored)
        return {name: {axis: told[name][axis] for axis in ("o", "z", "x") if told[name].get(axis) is not None} for name in names}

    def _in_freecad(self, trace: Json, script: list[Json]) -> tuple[bytes, Json, list[Json]]:
        """Return the document that FreeCAD makes, the measures of its solid, and those at each variation."""
        job = tree_objects(trace.get("rows"), trace.get("formulas"), self._dimensions, self._source.splitlines())
        changes = [_changed(self._dimensions, row["dimensions"]) if row["ok"] else {} for row in script[1:]]
        job |= {"dimensions": self._dimensions, "variations": changes}
        with self._kernel.job_folder() as folder:
            (folder / "job.json").write_text(json.dumps(job))
            ended = self._freecad.run(_PROGRAM, folder=folder, limits=FreeCADLimits(seconds=_SECONDS))
            if not ended.ok or not (folder / "report.json").is_file():
                raise NoTreeError("FreeCAD takes too long over its features" if ended.late else "FreeCAD fails on its features")
            report = json.loads(read_left(folder / "report.json", _REPORT_BYTES))
            if "problem" in report:
                raise NoTreeError(scrubbed(report["problem"], 300))
            try:
                content = read_left(folder / "part.FCStd", MAX_TREE_BYTES)
            except UnsafeFileError as error:
                raise NoTreeError(f"its document cannot be read: {error.strerror}") from None
        nominal, again = report["nominal"], report["again"]
        if not nominal.get("ok") or not again.get("ok") or _difference(again, nominal, nominal, nominal):
            raise NoTreeError("FreeCAD's features do not come back to the solid they started from")
        return content, nominal, report["varied"]


class NoTreeError(Exception):
    """A part has no tree; the message says why."""


def _moved(value: float, step: float) -> float:
    return value * (1 + step) if value else step * 10


def _moves(name: str, value: float, up: bool) -> list[float]:
    """Return the values to which one dimension is changed, smaller changes last: a script may refuse large ones."""
    if isinstance(value, int) and name.endswith("_count"):
        return [value + 1, value + 2, value - 1] if value > 1 else [value + 1, value + 2]
    steps, zero = (_STEPS[up], _ZERO_STEPS[up])
    return [float(value) * (1 + step) for step in steps] if value else list(zero)


def _changed(before: Mapping[str, float], after: Mapping[str, float]) -> dict[str, float]:
    return {name: value for name, value in after.items() if value != before[name]}


def _measures(line: Json) -> Json:
    """Return the validated measures of a solid at one variation."""
    if line.get("ok") is not True:
        return {"ok": False}
    faces, choice, volume, area = line.get("faces"), line.get("choice"), number(line.get("volume_mm3")), number(line.get("area_mm2"))
    if type(faces) is not int or type(choice) is not int or choice < 0 or volume <= 0 or area <= 0:
        raise PoisonedError("a measure has the wrong form")
    return {
        "ok": True,
        "choice": choice,
        "faces": faces,
        "volume_mm3": volume,
        "area_mm2": area,
        "com_mm": numbers(line.get("com_mm"), 3).tolist(),
        "inertia_mm5": numbers(line.get("inertia_mm5"), 3, 3).tolist(),
    }


def _difference(mine: Json, theirs: Json, mine_before: Json, theirs_before: Json) -> str:
    """Return how FreeCAD's solid differs from the script's; empty if it does not.

    Both kernels split faces by their own rules, so the numbers of faces are equal or change alike.
    """
    if not mine.get("ok"):
        return f"FreeCAD cannot compute {', '.join(mine.get('invalid', [])) or 'one valid solid'}"
    volume, area = theirs["volume_mm3"], theirs["area_mm2"]
    reach = math.sqrt(area)
    for what, unit, tolerance in (
        ("volume", "mm³", SAME * abs(volume)),
        ("area", "mm²", SAME * area),
        ("com", "mm", SAME * reach),
        ("inertia", "mm⁵", 10 * SAME * abs(volume) * reach**2),
    ):
        off = float(np.abs(np.subtract(mine[f"{what}_{_UNITS[unit]}"], theirs[f"{what}_{_UNITS[unit]}"])).max())
        if not off <= tolerance:
            return f"its {what.replace('com', 'centre')} is {off:.3g} {unit} off"
    if mine["faces"] not in (theirs["faces"], theirs["faces"] + mine_before["faces"] - theirs_before["faces"]):
        return f"{mine['faces']} faces instead of {theirs['faces']}"
    return ""
