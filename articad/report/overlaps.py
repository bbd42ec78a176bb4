"""Overlaps as meshes for the page, each in the pose in which it was found."""

from __future__ import annotations

from articad.aliases import Json
from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.interference.overlap_meshes import overlap_meshes
from articad.report.drawing import drawn_mesh

_MOST = 16  # overlaps that are drawn; the tables list all of them
_TRIED = 2 * _MOST  # pairs whose common solids are computed: somebody's reports may name any number that do not overlap
_TRIANGLES = 4000  # of one overlap


def drawn_overlaps(assembly: Assembly, *reports: Json | None) -> list[Json]:
    """Return the overlaps that reports name and no plan allows, deepest first: two parts, the drivers that are not at rest, a mesh.

    Args:
        assembly: The assembly that was checked.
        reports: Reports with `pairs`, as `articad.checks/1` and `articad.certificate/2`.
    """
    index = {name: number for number, name in enumerate(assembly.mechanism.parts)}
    pairs = [pair for report in reports if report for pair in report["pairs"]]
    wrong = [
        pair for pair in pairs if pair["verdict"] == "overlap" and pair["strength"]["kind"] != "waived" and set(pair["parts"]) <= set(index)
    ]
    drivers = {driver.name for driver in assembly.drivers}
    found: list[Json] = []
    seen: set[tuple[object, ...]] = set()
    for pair in sorted(wrong, key=lambda pair: -(pair["depth_mm"] or 0.0)):
        pose = {name: value for name, value in (pair.get("pose") or {}).items() if name in drivers}
        key = (*pair["parts"], *sorted(pose.items()))
        if key in seen:
            continue
        if len(found) >= _MOST or len(seen) == _TRIED:
            break
        seen.add(key)
        try:
            placed = assembly.poses(assembly.q(**pose))
        except ArticadError:  # a pose that the product cannot take: somebody has changed it, or the report
            continue
        poses = {name: placed[index[name]] for name in pair["parts"]}
        numbers = [index[name] for name in pair["parts"]]
        meshes = overlap_meshes({name: assembly.parts[name] for name in pair["parts"]}, poses)
        found += [{"parts": numbers, "pose": pose, "mesh": drawn_mesh(mesh)} for mesh in meshes if 0 < len(mesh.triangles) <= _TRIANGLES]
    return found
