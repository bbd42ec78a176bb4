"""Finds orders of assembly of the examples, the recorded runs and the hard tasks' references, samples their paths again, and writes the page.

    python scripts/orders.py                     # all that are new, or were judged by earlier programs
    python scripts/orders.py four_bar task:oldham_offset
    python scripts/orders.py --page              # only write the page, from docs/reference/orders.json

Results are kept in docs/reference/orders.json, each with a digest of the product and of the programs that judged it.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

import articad
from articad.agents.pipeline import replay
from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.disassembly.opened import step_poses
from articad.disassembly.steps import AssemblyOrder, Blocked
from articad.disassembly.ways import Ways
from articad.interference.body import body_of
from articad.interference.overlap import overlap
from articad.runs.record import assembly_of
from articad_bench.reference import reference_folder
from articad_bench.task import tasks_in

ROOT: Final = Path(__file__).resolve().parent.parent
STORED: Final = ROOT / "docs" / "reference" / "orders.json"
PAGE: Final = STORED.with_suffix(".md")
SCHEMA: Final = "articad.orders/1"
PLACES: Final = 60  # on each move of a path
JUDGES: Final = ("disassembly", "interference")  # packages that decide an order
WORDS: Final = "disassembly/steps.py"  # the form of an order and its words, which decide nothing

SETS: Final = {"": "Examples", "run": "Recorded runs", "task": "References of hard tasks"}


class Product(NamedTuple):
    """What is put together: its key such as `task:oldham_offset`, its folder, and whether that is a recording."""

    key: str
    folder: Path
    recorded: bool

    @property
    def digest(self) -> str:
        """Of the files that make the product."""
        found = hashlib.sha256()
        for file in sorted(file for file in self.folder.rglob("*") if file.suffix in {".json", ".py"}):
            found.update(f"{file.relative_to(self.folder)}\n".encode() + file.read_bytes())
        return found.hexdigest()[:12]


def products() -> list[Product]:
    """Return the examples, the recorded runs and the references of the hard tasks."""
    found = []
    for folder in sorted(path for path in (ROOT / "examples").iterdir() if path.is_dir()):
        recorded = not (folder / "plan.json").is_file()
        found.append(Product(folder.name, folder / "recording" if recorded else folder, recorded))
    recordings = sorted(file.parent for file in (ROOT / "tests" / "recordings").rglob("request.json"))
    found += [Product(f"run:{folder.name}", folder, recorded=True) for folder in recordings]
    found += [Product(f"task:{task.name}", reference_folder(folder, task), recorded=False) for folder, task in tasks_in(kind="hard")]
    return found


def programs() -> str:
    """Return a digest of the programs that decide an order."""
    found = hashlib.sha256()
    folder = Path(str(articad.__file__)).parent
    for file in sorted(file for package in JUDGES for file in (folder / package).glob("*.py")):
        if file != folder / WORDS:
            found.update(f"{file.relative_to(folder)}\n".encode() + file.read_bytes())
    return found.hexdigest()[:12]


def built(product: Product) -> Assembly:
    """Return the assembly of a product; a recorded run is made again from its answers."""
    if not product.recorded:
        return articad.read(product.folder).product()
    with tempfile.TemporaryDirectory() as scratch:
        made = replay(product.folder, out=Path(scratch) / "run")
        with made.run:
            return assembly_of(made.run).product()


def judged(product: Product) -> dict[str, Any]:
    """Return the row of a product."""
    assembly = built(product)
    assembly.scene()
    begun = time.process_time()
    order = assembly.assembly_order()
    seconds = time.process_time() - begun
    return {
        "product": product.digest,
        "programs": programs(),
        "parts": len(assembly.parts),
        "steps": len(order.steps),
        "seconds": round(seconds, 1),
        "permitted": [[a, b, how] for step in order.steps for a, b, how in step.permitted],
        "two_moves": sum(len(step.moves) > 1 for step in order.steps),
        "elsewhere": sum(bool(step.at) for step in order.steps),
        "wait": sum(step.slides for step in order.steps),
        "blocked": [_blocked(each) for each in order.blocked],
        "left_out": list(order.left_out),
        "sampled": sampled(assembly, order),
    }


def _blocked(blocked: Blocked) -> dict[str, Any]:
    return {"parts": list(blocked.parts), "best": {row.part: [round(row.travel_mm, 2), row.by] for row in blocked.stops}}


def sampled(assembly: Assembly, order: AssemblyOrder) -> dict[str, Any]:
    """Return how many places of paths were examined by Booleans of the solids, and by how much the worst is deeper than allowed [mm]."""
    scene, places, pairs, worst = assembly.scene(), 0, 0, -np.inf
    for step in order.steps:
        if not step.moves:
            continue
        poses = step_poses(assembly.mechanism, step, order.base)
        ways, permitted = Ways(scene, poses), {frozenset(pair[:2]) for pair in step.permitted}
        points = {name: ways.points(name) for name in (*step.parts, *step.onto)}
        standing = {name: _box(points[name]) for name in step.onto}
        beyond = np.zeros(3)
        for move in reversed(step.moves):  # out again
            for share in np.linspace(0, 1, PLACES):
                offset = beyond - share * move.length_mm * np.array(move.direction)
                moved = SE3.from_translation(offset)
                if move.axis_point is not None:
                    moved = moved @ SE3.from_axis_angle(-np.array(move.direction), share * move.turns * 2 * np.pi, about=move.axis_point)
                places += 1
                for part in step.parts:
                    low, high = _box(moved.apply(points[part]))
                    for other in step.onto:
                        near = (low <= standing[other][1]).all() and (high >= standing[other][0]).all()
                        if not near or frozenset((part, other)) in permitted:
                            continue
                        pairs += 1
                        T = poses[other].inverse() @ moved @ poses[part]
                        found = overlap(body_of(scene.meshes[other]), body_of(scene.meshes[part]), T)
                        worst = max(worst, found.depth - ways.depth(part, other))
            beyond = beyond - move.length_mm * np.array(move.direction)
    return {"places": places, "pairs": pairs, "worst_mm": None if np.isinf(worst) else round(float(worst), 6)}


def _box(points: FloatArray) -> FloatArray:
    """Return the least and the greatest coordinates of points, `(2, 3)`."""
    return np.array([points.min(axis=0), points.max(axis=0)])


LOOKED: Final[Mapping[str, str]] = {
    "run:drill": "The pinion is one piece with its shaft and wider than the closed bores of the head on both sides of it. The belt is a closed loop between two flanges; "
    "a person stretches it over them, which the plan does not state.",
    "run:metronome": "The hinge pin is one piece with the two ears of the housing and passes through the closed knuckle of the cover. Key and bell knob are one piece each, with a head outside "
    "and a collar inside that are wider than the housing's closed bores.",
    "run:mirrored": "The rail is longer than the space between the sides of the carcass, which is one piece, and its ends are in blind sockets; the doors' pins, above and below, "
    "are in blind holes of top and shelf, as the plan says.",
    "run:phone_holder": "The holder's ball is in a closed socket of the arm that reaches over more than half of it; a workshop snaps it in, or makes the socket of two halves.",
    "run:pliers": "The lever is one piece of two cheeks and the pins between them, which pass through closed eyes of the lower jaw and of the strut.",
    "run:stool": "Each leg frame is one piece with the rods between its legs, and the rods lie in closed eyes of the seat's lugs and of the braces; the rod of the outer frame "
    "passes through closed bores of the inner legs.",
    "run:tempo": "The escape wheel is one piece with its arbor, between the two plates of the frame, which are one piece and closed about it; the pendulum likewise. "
    "The selector is one piece with a knob outside and a head inside the case, both wider than its bore.",
    "run:toaster": "The housing is one closed box with the two rods in it on which the lifter slides, in closed bushes.",
    "run:toy": "Each shaft is one piece with a wheel inside the body that is wider than the closed bores, and the crankshafts with webs outside; the body is one piece.",
    "metronome": "The case is one hollow piece around its nut and its barrel.",
    "scissor_lift": "Each frame is one piece of two arms and their cross rods, and the rods lie in closed eyes of the other frames, inside its own two arms.",
    "slider_crank": "The rod's eye is one closed piece about the crank pin, and the piston stays in its cylinder at every angle of the crank, so that the eye "
    "never gets past the pin.",
    "stewart_platform": "Each cross is one piece, and its four journals lie in closed eyes of the two forks; each ball is in a closed socket of the platform that reaches over more than half of it.",
    "table_football": "Each rod is one piece with two collars between the side walls, which are wider than the closed bores; the walls are one piece. The score bar is one piece with posts at both ends "
    "that are larger than the bead's hole.",
    "task:cardan_shaft": "Each cross is one piece, and its four journals lie in closed eyes of the two forks; a workshop makes the bearings as cups.",
    "task:delta_robot": "The pins of base and platform are one piece with the lugs on both sides of them, and pass through closed eyes; each elbow and wrist is a cross of one piece, with four journals "
    "in closed eyes.",
    "task:differential_axle": "The cage is one closed piece with the pin of the spider gears, between side gears that are one piece with axle and wheel.",
    "task:engine_inline_three": "The crankshaft is one piece, and each rod has a closed eye about a crank pin between two cheeks; a workshop splits the eye.",
    "task:engine_radial": "Each rod comes off its pin to the front only, and is on a pin of its piston, which leaves its closed cylinder along that cylinder only.",
    "task:jack_scissor": "The screw turns on a neck in the bore of the trunnion, between its thread and its collar, which are wider; all is one piece.",
    "task:orrery_three": "The post is one piece with the base and with the sun at its top, which is wider than the eyes of the planets' arms on the post.",
    "task:platform_six_legs": "Each cross is one piece with four journals in closed eyes of two forks; each ball is in a closed socket that reaches over more than half of it.",
    "task:sarrus_lifter": "Each leaf is between two lugs whose pins reach into its eye from both sides; lugs, pins and plate are one piece, below as above.",
    "task:scotch_yoke_pump": "The crank pin is one piece with the disc below the block and with a head above it that is wider than the block's bore; the yoke's rods end "
    "in posts on both sides, which are one piece with the base.",
    "task:sewing_head": "The needle bar leaves the top of its rod only above the highest place to which the crank brings it. The needle rod is between crank and needle bar, "
    "whose pins are in its eyes from both sides.",
    "task:shaper_quick_return": "The rod of the ram passes through a closed bore and ends in posts on both sides, which are one piece with the base; the link is on the pins of lever "
    "and ram from both sides.",
    "task:vice_dividing": "The spindle is one piece with a screw between the blocks of the bed that is wider than their closed bores, and with a bar outside; the blocks are one piece with the "
    "bed.",
    "task:tongs_lazy": "The slide leaves the lower end of its rod only below the height at which the tongs, drawn out, stop: there the pin of `falling` meets the eye of `rising`. "
    "`falling` is between `rising` and the slide, whose pins are in its eyes from both sides.",
    "task:umbrella_frame": "The pins of crown and runner are one piece with the walls of the slots on both sides of them, and pass through closed eyes of the ribs and stretchers.",
    "task:steering_rack": "The rod on which the rack bar slides passes through a closed bore and ends in posts on both sides, which are one piece with the chassis.",
}
"""What was seen on the picture of each product that no order puts together."""

REFUTED: Final[Mapping[str, str]] = {}
"""How a person puts a product together for which the search finds no order."""

ABOUT: Final = """\
# Orders of assembly

<!-- Written by `python scripts/orders.py` from orders.json; run that again. -->

`articad order` for every example, every recorded run, and the reference of every hard task of the benchmark. [Can it be built?](../how-to/can-it-be-built.md)
explains what is proven.

- **seconds**: processor time of the search, without the build of the parts.
- **proven**: every step's path is proven. *n by force*: so many pairs of parts are joined as the plan states (snap, press, circlip, bought as one), or turned into each other's thread.
- **sampled**: every path was examined again with manifold3d: Booleans of the solids at 60 places of each move, for every moving and every placed part
  whose boxes meet there. The number is by how much the deepest overlap is deeper than the joint of the two parts allows: negative means clear of that.
- What no order puts together is named below, with what was seen on its picture: what blocks it, or how a person puts it together all the same.
"""


def page(stored: Mapping[str, Any]) -> str:
    """Return the page of stored results."""
    rows: Mapping[str, Any] = stored["rows"]
    newest = sum(row["programs"] == stored["programs"] for row in rows.values())
    solved = [row for row in rows.values() if _solved(row)]
    slowest = max(rows, key=lambda key: rows[key]["seconds"])
    places, pairs = (sum(row["sampled"][key] for row in rows.values()) for key in ("places", "pairs"))
    told = (
        f"{len(rows)} of {len(stored['planned'])} products were examined, {newest} of them by the newest programs: {len(solved)} have an order, for {len(rows) - len(solved)} none was found"
        f"{_confirmed(rows)}. The search of `{slowest}` took longest: {rows[slowest]['seconds']:g} s for {rows[slowest]['parts']} parts. "
        f"{places} places of paths were sampled, with {pairs} Booleans."
    )
    lines = [ABOUT, told]
    for prefix, title in SETS.items():
        mine = {key: row for key, row in rows.items() if key.rpartition(":")[0] == prefix}
        lines += ["", f"## {title}", "", "| product | parts | steps | seconds | verdict | sampled, mm |", "|---|---|---|---|---|---|"]
        for key, row in sorted(mine.items()):
            old = "" if row["programs"] == stored["programs"] else " (earlier programs)"
            worst = row["sampled"]["worst_mm"]
            name = key.rpartition(":")[2]
            lines.append(
                f"| `{name}` | {row['parts']} | {row['steps']} | {row['seconds']:g} | {_verdict(row)}{old} | {'' if worst is None else f'{worst:.2f}'} |"
            )
    unknown = [f"`{key}`" for key in stored["planned"] if key not in rows]
    if unknown:
        lines += ["", f"Not examined yet: {', '.join(unknown)}."]
    lines += ["", "## What blocks", ""]
    for key, row in sorted(rows.items()):
        for blocked in row["blocked"]:
            ways = "; ".join(f"`{part}` {travel:.3g} mm to `{by}`" for part, (travel, by) in blocked["best"].items())
            seen = f"*Not confirmed.* {REFUTED[key]}" if key in REFUTED else LOOKED.get(key, "Not looked at yet.")
            lines += [f"- **`{key.rpartition(':')[2]}`**: {seen} Farthest ways: {ways}."]
    return "\n".join(lines).rstrip() + "\n"


def _confirmed(rows: Mapping[str, Any]) -> str:
    """Return of how many blocked products the picture confirms it."""
    blocked = {key for key, row in rows.items() if row["blocked"]}
    return f" (blockers confirmed on the picture: {len(blocked & set(LOOKED))}, refuted: {len(blocked & set(REFUTED))})"


def _solved(row: Mapping[str, Any]) -> bool:
    return not row["blocked"] and not row["left_out"]


def _verdict(row: Mapping[str, Any]) -> str:
    if row["left_out"]:
        return f"without valid solid: {', '.join(row['left_out'])}"
    if row["blocked"]:
        return f"blocked: {sum(len(blocked['parts']) for blocked in row['blocked'])} parts"
    told = ["proven"]
    if row["permitted"]:
        told.append(f"{len(row['permitted'])} by force")
    if row["two_moves"]:
        told.append(f"{row['two_moves']} in two moves")
    if row["elsewhere"]:
        told.append(f"{row['elsewhere']} at another pose")
    if row.get("wait"):
        told.append(f"{row['wait']} after waiting beside")
    return ", ".join(told)


def stored_results() -> dict[str, Any]:
    """Return what is stored."""
    return (
        json.loads(STORED.read_text(encoding="utf-8"))
        if STORED.is_file()
        else {"schema": SCHEMA, "programs": programs(), "planned": [], "rows": {}}
    )


def stored_page() -> str:
    """Return the page of the stored results, for a check that it is current."""
    return page(stored_results())


def write(stored: Mapping[str, Any]) -> None:
    """Write results and page."""
    rows = {key: stored["rows"][key] for key in sorted(stored["rows"])}
    body = ",\n".join(f"  {json.dumps(key)}: {json.dumps(row)}" for key, row in rows.items())  # a product a line
    head = f'{{\n "schema": "{SCHEMA}",\n "programs": "{stored["programs"]}",\n "planned": {json.dumps(stored["planned"])},\n "rows": {{\n'
    STORED.write_text(f"{head}{body}\n }}\n}}\n", encoding="utf-8")
    PAGE.write_text(page(stored), encoding="utf-8")


def main(arguments: list[str]) -> int:
    """Judge products, and write results and page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "names", nargs="*", help="products, such as four_bar, run:toy or task:oldham_offset; all whose results are old by default"
    )
    parser.add_argument("--page", action="store_true", help="judge nothing; write the page of what is stored")
    options = parser.parse_args(arguments)
    stored = stored_results()
    found = {product.key: product for product in products()}
    unknown = [name for name in options.names if name not in found]
    if unknown:
        print(f"There is no {', '.join(unknown)}. There are {', '.join(found)}.", file=sys.stderr)
        return 2
    stored["rows"] = {key: row for key, row in stored["rows"].items() if key in found}
    stored |= {"programs": programs(), "planned": list(found)}
    for key, product in found.items():
        row = stored["rows"].get(key, {})
        old = (row.get("product"), row.get("programs")) != (product.digest, programs())
        if options.page or (key not in options.names if options.names else not old):
            continue
        stored["rows"][key] = judged(product)
        write(stored)
        print(f"{key}: {_verdict(stored['rows'][key])}", flush=True)
    write(stored)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
