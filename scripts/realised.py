"""Checks how the joints of the benchmark's references are made and what carries their parts, tries each finding on the meshes, and writes the page.

    python scripts/realised.py                     # all that are new, or were judged by earlier programs
    python scripts/realised.py axle_watt bin_pedal
    python scripts/realised.py --page              # only write the page, from docs/reference/realised.json

Results are kept in docs/reference/realised.json, each with a digest of the product and of the programs that judged it.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import math
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from scipy.spatial import Delaunay

import articad
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.poses import poses_at
from articad.findings import Finding
from articad.interference.body import body_of
from articad.interference.freedoms import freedoms
from articad.interference.gauge import fixed_with, placed
from articad.interference.overlap import overlap
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from articad.realisation.verdicts import FreeWay, JointCheck
from articad_bench.reference import reference_folder
from articad_bench.task import tasks_in

ROOT: Final = Path(__file__).resolve().parent.parent
STORED: Final = ROOT / "docs" / "reference" / "realised.json"
PAGE: Final = STORED.with_suffix(".md")
SCHEMA: Final = "articad.realised/1"
JUDGES: Final = ("realisation", "support", "interference")  # packages that decide a finding

FREE_MM: Final = 5.0  # what moves this far is not held there
FREE_RAD: Final = 0.15
STEP_MM: Final = 0.25
STEP_RAD: Final = 0.025
DEEP_MM: Final = 0.02  # besides the deflections of the two meshes: what overlaps by less touches
PIVOTS: Final = (5, 41)  # places on each of two axes about which a tilt is tried; the second if it is stopped at all of the first

Placed = Mapping[str, SE3]


def programs() -> str:
    """Return a digest of the programs that decide a finding."""
    found = hashlib.sha256()
    folder = Path(str(articad.__file__)).parent
    for file in sorted(file for package in JUDGES for file in (folder / package).glob("*.py")):
        found.update(f"{file.relative_to(folder)}\n".encode() + file.read_bytes())
    return found.hexdigest()[:12]


def digest(folder: Path) -> str:
    """Return a digest of the files that make a product."""
    found = hashlib.sha256()
    for file in sorted(file for file in folder.rglob("*") if file.suffix in {".json", ".py"}):
        found.update(f"{file.relative_to(folder)}\n".encode() + file.read_bytes())
    return found.hexdigest()[:12]


def references() -> dict[str, Path]:
    """Return the folder of the reference of each task that has one; those that separate may take files of their references from other folders."""
    chosen = [(folder, task) for folder, task in tasks_in() if task.reference is not None and task.kind != "separating"]
    return {task.name: reference_folder(folder, task) for folder, task in chosen}


# ------------------------------------------------------------------ the meshes


def collides(scene: Scene, poses: Placed, movers: Sequence[str], others: Sequence[str], motion: SE3) -> str | None:
    """Return the first of the other parts that the moved parts enter, by Booleans of the solids; None if there is none."""
    for other in others:
        for part in movers:
            moved = motion @ poses[part]
            a, b = moved.apply(scene.meshes[part].vertices), poses[other].apply(scene.meshes[other].vertices)
            if (a.min(axis=0) > b.max(axis=0)).any() or (b.min(axis=0) > a.max(axis=0)).any():
                continue
            found = overlap(body_of(scene.meshes[other]), body_of(scene.meshes[part]), poses[other].inverse() @ moved)
            if found.depth > DEEP_MM + scene.deflections.get(part, 0.0) + scene.deflections.get(other, 0.0):
                return other
    return None


def travel(scene: Scene, poses: Placed, movers: Sequence[str], still: Sequence[str], way: np.ndarray[Any, Any]) -> tuple[float, str | None]:
    """Return how far parts move along a direction until they enter one that stands still, up to FREE_MM, and which [mm]."""
    for step in np.arange(STEP_MM, FREE_MM + STEP_MM / 2, STEP_MM):
        stop = collides(scene, poses, movers, still, SE3.from_translation(step * way))
        if stop is not None:
            return float(step - STEP_MM), stop
    return FREE_MM, None


def pushing(
    scene: Scene, poses: Placed, movers: Sequence[str], still: Sequence[str], others: Sequence[str], way: np.ndarray[Any, Any]
) -> tuple[float, str | None, list[str]]:
    """Return how far parts move along a direction until one of them enters a part that stands still, which, and the others that they push along.

    A part that is entered is pushed from there on, with those that are fixed to it. Each push is known to STEP_MM.
    """
    begun, pushed = dict.fromkeys(movers, 0.0), list[str]()
    for step in np.arange(STEP_MM, FREE_MM + STEP_MM / 2, STEP_MM).tolist():
        todo = list(begun)
        for part in todo:  # grows while parts are entered
            ahead = [*still, *(name for name in others if name not in begun)]
            while (stop := collides(scene, poses, [part], ahead, SE3.from_translation((step - begun[part]) * way))) is not None:
                if stop in still:
                    return step - STEP_MM, stop, pushed
                along = [name for name in others if name not in begun and (name == stop or scene.relations.rigid.together(name, stop))]
                begun |= dict.fromkeys(along, step - STEP_MM)
                pushed += along
                todo += along
                ahead = [name for name in ahead if name not in begun]
    return FREE_MM, None, pushed


def tilt(scene: Scene, poses: Placed, movers: Sequence[str], still: Sequence[str], frame: SE3, axis: int) -> tuple[float, str | None]:
    """Return how far parts turn about an axis of a frame, at the best of some pivots, up to FREE_RAD, and what stops them.

    Pivots are on the two axes of the frame across that axis, over the length of the parts: a lever in a slot turns about the slot.
    """
    corners = np.concatenate([(frame.inverse() @ poses[name]).apply(scene.meshes[name].vertices) for name in movers])
    best: tuple[float, str | None] = (-1.0, None)
    for count, along in itertools.product(PIVOTS, [other for other in (2, 1, 0) if other != axis]):
        for place, sign in itertools.product(np.linspace(corners[:, along].min(), corners[:, along].max(), count), (1.0, -1.0)):
            about = frame @ SE3.from_translation(place * np.eye(3)[along])
            angle, stop = 0.0, None
            for step in np.arange(STEP_RAD, FREE_RAD + STEP_RAD / 2, STEP_RAD):
                stop = collides(
                    scene, poses, movers, still, about @ SE3.from_axis_angle(np.eye(3)[axis], sign * float(step)) @ about.inverse()
                )
                if stop is not None:
                    break
                angle = float(step)
            if angle > best[0]:
                best = (angle, stop)
            if stop is None:
                return best
    return best


def tried(scene: Scene, assembly: Assembly, joint: Joint, row: JointCheck, loss: FreeWay) -> dict[str, Any]:
    """Return what a motion that a joint is said to leave free does on the meshes: of the child and all that is fixed to it, past the parent's.

    Other parts are not in the way if they move along: a part that is entered is pushed, unless it is fixed to the parent.
    """
    poses: dict[str, SE3] = dict(poses_at(assembly.mechanism, {}))
    parents, movers = list(fixed_with(scene, joint, joint.parent)), list(fixed_with(scene, joint, joint.child))
    others = [name for name in scene.meshes if name not in parents and name not in movers and name not in scene.environment]
    if row.at is not None:
        values = [row.at.get(freedom.name, freedom.rest) for freedom in freedoms(joint)]
        there = poses[joint.parent] @ SE3.from_matrix(np.asarray(placed(joint, values))) @ poses[joint.child].inverse()
        poses |= {name: there @ poses[name] for name in movers}
        others = []  # where they are at that pose is not asked
    frame = poses[joint.parent] @ joint.T_parent_connector
    if loss.way.startswith("about "):
        far, stop = tilt(scene, poses, movers, parents, frame, "xyz".index(loss.way[-1]))
        return {"way": loss.way, "free": far >= FREE_RAD - 1e-9, "rad": round(far, 4), "stop": stop, "pushed": []}
    way = np.asarray(frame.rotation)[:, "xyz".index(loss.way[-1])] * (1.0 if loss.way[0] == "+" else -1.0)
    far, stop, pushed = pushing(scene, poses, movers, parents, others, way)
    alone, end = travel(scene, poses, movers, parents, way) if pushed and stop is not None else (far, stop)
    return {
        "way": loss.way,
        "free": stop is None,
        "mm": round(far, 3),
        "stop": stop,
        "pushed": pushed,
        "alone": end is None,
        "alone_mm": round(alone, 3),
    }


def falls(scene: Scene, assembly: Assembly, finding: Finding) -> dict[str, Any]:
    """Return how far parts that nothing carries move down on the meshes, all others at rest."""
    poses = poses_at(assembly.mechanism, dict(finding.pose or {}))
    movers = list(finding.parts)
    still = [name for name in scene.meshes if name not in movers and name not in scene.environment]
    far, stop = travel(scene, poses, movers, still, np.array([0.0, 0.0, -1.0]))
    return {"way": "down", "free": stop is None, "mm": round(far, 3), "stop": stop, "pushed": []}


def stands(scene: Scene, assembly: Assembly, finding: Finding) -> dict[str, Any]:
    """Return whether the centre of mass, integrated over the meshes, is over the triangles that span the lowest points."""
    poses = poses_at(assembly.mechanism, dict(finding.pose or {}))
    masses = {name: part.mass.mass for name, part in assembly.parts.items() if part.mass is not None and name in scene.meshes}
    weights, centres, points = [], [], []
    for name, mass in masses.items():
        mesh = scene.meshes[name]
        a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        middle = ((a + b + c) / 4 * volumes[:, None]).sum(axis=0) / volumes.sum()
        weights.append(mass)
        centres.append(poses[name].apply(middle[None])[0])
        points.append(poses[name].apply(mesh.vertices))
    com, every = np.average(centres, axis=0, weights=weights), np.concatenate(points)
    feet = np.unique(np.round(every[every[:, 2] <= every[:, 2].min() + 0.1][:, :2], 6), axis=0)
    flat = len(feet) > 2 and np.linalg.matrix_rank(feet - feet.mean(axis=0), tol=1e-3) == 2
    inside = bool(flat and Delaunay(feet).find_simplex(com[:2]) >= 0)
    return {"way": "tips", "free": not inside, "com_mm": [round(float(x), 3) for x in com], "feet": len(feet)}


# ------------------------------------------------------------------ results


def judged(folder: Path) -> dict[str, Any]:
    """Return the row of a product."""
    begun = time.process_time()
    assembly = articad.read(folder).product()
    scene, made = assembly.scene(), assembly.check_joints()
    checks, joints = {row.joint: row for row in made.rows}, {joint.name: joint for joint in scene.relations.joints}
    found = []
    for finding in made.findings:
        row = checks.get(finding.where.removeprefix("joints."))
        losses = () if row is None or finding.code == "W_JOINT_SHORT" else [loss for loss in row.losses if not loss.by_weight]
        found.append(
            _told(
                finding, [] if row is None else [_with_room(tried(scene, assembly, joints[row.joint], row, loss), loss) for loss in losses]
            )
        )
    for finding in assembly.check_support().findings:
        oracle = {"W_NOT_CARRIED": falls, "W_TIPS_OVER": stands}.get(finding.code)
        found.append(_told(finding, [] if oracle is None else [oracle(scene, assembly, finding)]))
    return {
        "product": digest(folder),
        "programs": programs(),
        "joints": dict(Counter(row.verdict for row in made.rows)),
        "findings": found,
        "seconds": round(time.process_time() - begun, 1),
    }


def _with_room(one: dict[str, Any], loss: FreeWay) -> dict[str, Any]:
    told = one if math.isinf(loss.room) else one | {"room": round(loss.room, 4)}
    return told if loss.holding is None else told | {"held": round(loss.holding.travel, 4), "held_by": list(loss.holding.parts)}


def agrees(one: Mapping[str, Any]) -> bool:
    """Return whether the meshes say of a motion what the finding does: nothing stops it, its partner does where its play is said to end, or others do."""
    room = one.get("room", math.inf)
    if "held" in one:
        within = (STEP_MM + DEEP_MM) * len(one["held_by"])
        partner = one["alone"] if room >= FREE_MM else abs(one["alone_mm"] - room) <= STEP_MM + DEEP_MM
        return partner and abs(one["mm"] - one["held"]) <= within and (not one["free"] or one["held"] >= FREE_MM - within)
    if "mm" not in one or room >= FREE_MM:
        return bool(one["free"])
    return not one["free"] and abs(one["mm"] - room) <= STEP_MM + DEEP_MM


def _told(finding: Finding, trials: list[dict[str, Any]]) -> dict[str, Any]:
    return {"code": finding.code, "where": finding.where, "parts": list(finding.parts), "message": finding.message, "tried": trials}


ARGUED: Final[Mapping[tuple[str, str], str]] = {
    ("grinder_coffee", "joints.drawer"): "The drawer is 92 mm deep and comes out by 70 mm: 22 of 92 mm stay in the box, 23.9 %.",
    ("headphones_studio", "joints.left_size"): "The arm is 37 mm deep in its socket and comes out by 30 mm: 7 of 37 mm stay, 19 %.",
    ("headphones_studio", "joints.size"): "The arm is 37 mm deep in its socket and comes out by 30 mm: 7 of 37 mm stay, 19 %.",
    (
        "microscope_school",
        "couplings.rack",
    ): "The knob is a plain disc beside the tube's block, which is 60 mm high and leaves it upwards. The rack is not modelled.",
    (
        "suitcase_trolley",
        "joints.second",
    ): "The rods are 239.5 mm deep in their tubes and come out by 180 mm: 59.5 of 239.5 mm stay, 24.8 %.",
}
"""Of findings that the meshes stop, or that name no motion: what the dimensions of the parts say, by product and place."""

VERDICTS: Final = ("confirmed", "held by others", "stopped", "not tried")

ABOUT: Final = f"""\
# Joints and support of the references

<!-- Written by `python scripts/realised.py` from realised.json; run that again. -->

`articad check --joints --support` for the references of the benchmark's tasks. [Can it be built?](../how-to/can-it-be-built.md) explains what is examined.

Each finding is tried on the meshes by a method that shares nothing with the check, which reasons about faces to first order:

- **a joint leaves a translation free**: the child is moved that way by {FREE_MM:g} mm in steps of {STEP_MM:g} mm, and each place is a Boolean of the solids (manifold3d).
  The finding is true if the child never enters the parent. Other parts that it enters are pushed along, and are named. If the finding states a play of less than
  {FREE_MM:g} mm, it is true if the child enters the parent after that play, to one step. If it says that others hold the child, it is true if these, pushed along,
  end at the parent after that travel, to one step for each.
- **a joint leaves a rotation free**: the child is turned by {FREE_RAD:g} rad about that axis at up to {2 * PIVOTS[1]} places, the same way.
- **a part is not carried**: it is moved down by {FREE_MM:g} mm; all others stay.
- **the product tips over**: the centre of mass, from centres integrated over the triangles of the meshes, is outside the triangles that span its lowest points.

- *confirmed*: the meshes stop none of the motions that the finding names, or each play where it is said to end.
- *held by others*: the joint's own two parts do not stop them, but other parts between the two do, pushed against each other, and the finding does not say so.
- *stopped*: the joint's own parts stop one of them elsewhere; the finding is in question.
- *not tried*: the finding names no motion; it is argued below.
"""


def verdict(finding: Mapping[str, Any]) -> str:
    """Return what the meshes say of a finding: confirmed, held by others, stopped or not tried."""
    if not finding["tried"]:
        return "not tried"
    if all(agrees(one) for one in finding["tried"]):
        return "confirmed"
    return "held by others" if all(agrees(one) or one.get("alone") for one in finding["tried"]) else "stopped"


def page(stored: Mapping[str, Any]) -> str:
    """Return the page of stored results."""
    rows: Mapping[str, Any] = stored["rows"]
    every = [(name, finding) for name, row in rows.items() for finding in row["findings"]]
    newest = sum(row["programs"] == stored["programs"] for row in rows.values())
    verdicts = Counter((finding["code"], verdict(finding)) for _, finding in every)
    joints = sum((Counter(row["joints"]) for row in rows.values()), Counter[str]())
    told = ", ".join(f"{count} {name}" for name, count in sorted(joints.items()))
    summary = (
        f"{len(rows)} of {len(stored['planned'])} references were examined, {newest} of them by the newest programs. "
        f"Their joints: {told}. {sum(not row['findings'] for row in rows.values())} references have no finding."
    )
    lines = [
        ABOUT,
        summary,
        "",
        "| finding | " + " | ".join(VERDICTS) + " |",
        "|---" * (1 + len(VERDICTS)) + "|",
    ]
    for code in sorted({code for code, _ in verdicts}):
        counts = " | ".join(str(verdicts[code, one]) for one in VERDICTS)
        lines += [f"| `{code}` | {counts} |"]
    lines += ["", "## Findings", "", "| product | finding | at | on the meshes |", "|---|---|---|---|"]
    for name, finding in sorted(every, key=lambda each: (each[0], each[1]["code"], each[1]["where"])):
        lines += [f"| `{name}` | `{finding['code']}` | `{finding['where']}` | {verdict(finding)}{_detail(finding)} |"]
    stopped = [(name, finding) for name, finding in every if verdict(finding) in ("stopped", "not tried")]
    if stopped:
        lines += ["", "## Argued", "", "What the meshes stop, or no motion can try, is held against the dimensions of the parts:", ""]
        lines += [
            f"- `{name}`, `{one['where']}`: {ARGUED.get((name, one['where']), 'Not argued yet.')}"
            for name, one in sorted(stopped, key=lambda each: each[0])
        ]
    unknown = [f"`{name}`" for name in stored["planned"] if name not in rows]
    if unknown:
        lines += ["", f"Not examined yet: {', '.join(unknown)}."]
    return "\n".join(lines).rstrip() + "\n"


def _detail(finding: Mapping[str, Any]) -> str:
    told = "; ".join(_motion(one) for one in finding["tried"])
    return f": {told}" if told else ""


def _motion(one: Mapping[str, Any]) -> str:
    if "com_mm" in one:
        return "outside" if one["free"] else "inside"
    far = f"{one['mm']:g} mm" if "mm" in one else f"{one['rad']:g} rad"
    pushed = f", with {' and '.join(f'`{name}`' for name in one['pushed'])}" if one["pushed"] else ""
    play = "" if "room" not in one else f", said to be {one['room']:.3g} {'mm' if 'mm' in one else 'rad'}"
    held = (
        "" if "held" not in one else f", said to be held by {', '.join(f'`{name}`' for name in one['held_by'])} after {one['held']:.3g} mm"
    )
    return f"{one['way']} {far}{pushed}" + ("" if one["free"] else f" to `{one['stop']}`") + play + held


def stored_results() -> dict[str, Any]:
    """Return what is stored."""
    if STORED.is_file():
        return dict(json.loads(STORED.read_text(encoding="utf-8")))
    return {"schema": SCHEMA, "programs": programs(), "planned": [], "rows": {}}


def stored_page() -> str:
    """Return the page of the stored results, for a check that it is current."""
    return page(stored_results())


def write(stored: Mapping[str, Any]) -> None:
    """Write results and page."""
    body = ",\n".join(f"  {json.dumps(name)}: {json.dumps(stored['rows'][name])}" for name in sorted(stored["rows"]))  # a product a line
    head = f'{{\n "schema": "{SCHEMA}",\n "programs": "{stored["programs"]}",\n "planned": {json.dumps(stored["planned"])},\n "rows": {{\n'
    STORED.write_text(f"{head}{body}\n }}\n}}\n", encoding="utf-8")
    PAGE.write_text(page(stored), encoding="utf-8")


def due(stored: Mapping[str, Any], found: Mapping[str, Path], names: Sequence[str]) -> Iterator[str]:
    """Yield the named products, or all whose results are missing or old."""
    for name, folder in found.items():
        row = stored["rows"].get(name, {})
        if name in names or (not names and (row.get("product"), row.get("programs")) != (digest(folder), programs())):
            yield name


def main(arguments: list[str]) -> int:
    """Judge products, and write results and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="tasks, such as axle_watt; all whose results are old by default")
    parser.add_argument("--page", action="store_true", help="judge nothing; write the page of what is stored")
    options = parser.parse_args(arguments)
    stored, found = stored_results(), references()
    unknown = [name for name in options.names if name not in found]
    if unknown:
        print(f"There is no {', '.join(unknown)}. There are {', '.join(found)}.", file=sys.stderr)
        return 2
    stored["rows"] = {name: row for name, row in stored["rows"].items() if name in found}
    stored |= {"programs": programs(), "planned": list(found)}
    for name in [] if options.page else list(due(stored, found, options.names)):
        stored["rows"][name] = judged(found[name])
        write(stored)
        told = [f"{one['code']} {verdict(one)}" for one in stored["rows"][name]["findings"]]
        print(f"{name}: {', '.join(told) or 'no finding'}", flush=True)
    write(stored)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
