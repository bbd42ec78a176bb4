"""Faulty products made by rule: a good plan and its scripts, with one mistake that is known.

A rule is a kind of mistake. It lists its sites in a product: all the places where the mistake can be made. `chosen` draws from these with a fixed
seed, so that the same cases come out every time.
"""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Final, Literal, Self

from articad import examples
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import PLAN_FILE, AssemblyPlan
from articad.runs.run import digest
from articad_bench.task import TASKS

__all__ = ["PRODUCTS", "Fault", "Kind", "Product", "Side", "Site", "chosen", "obedient"]

Json = dict[str, Any]
Side = Literal["plan", "script"]

PRODUCTS: Final = (
    *("desk_lamp", "four_bar", "geared_four_bar", "metronome", "scissor_lift", "slider_crank", "toggle_clamp", "wardrobe"),
    *("bookcase_low", "cabinet_filing", "clamp_c_frame_80", "corkscrew_wing", "door_bifold", "gears_18_36", "hinge_butt_pin"),
    *("rod_tie_two_balls", "scotch_yoke_pump", "screw_jack_bottle", "slide_dovetail_60", "turnbuckle_open_m12"),
)
"""Examples, and references of tasks: hinges, drawers, loops, gears, screws, balls, mirrored and static products."""

_SEED: Final = 28


@dataclass(frozen=True)
class Product:
    """A good answer: a plan as JSON, and the script of each part."""

    name: str
    plan: Json
    scripts: Mapping[str, str]

    @classmethod
    def named(cls, name: str) -> Self:
        """Return an example, or the reference of a task.

        Raises:
            ReadError: If there is none of this name.
        """
        return cls.read(name, cls.folder(name))

    @staticmethod
    def folder(name: str) -> Path:
        """Return the folder of an example, or of the reference of a task."""
        reference = TASKS / name / "reference"
        return reference if reference.is_dir() else examples.folder(name)

    @classmethod
    def read(cls, name: str, folder: Path) -> Self:
        """Return the product of a folder with `plan.json` and `parts/`."""
        plan = AssemblyPlan.load(folder / PLAN_FILE)
        own = [part.name for part in plan.parts if not hasattr(part, "derive")]
        return cls(name, plan.to_json(), {part: (folder / "parts" / f"{part}.py").read_text() for part in own})

    @cached_property
    def resolved(self) -> ResolvedPlan:
        """The plan with its numbers."""
        return resolve(AssemblyPlan.from_json(self.plan))


@dataclass(frozen=True)
class Site:
    """A place where a mistake can be made.

    Attributes:
        said: What is changed there.
        names: Parts, joints and other entries of the plan; a finding has to name one of them.
        plan: Makes the mistake in a copy of the plan.
        script: For a mistake in a script: the part, and a function that returns the source of its faulty script.
    """

    said: str
    names: frozenset[str]
    plan: Callable[[Json], object] | None = None
    script: tuple[str, Callable[[], str]] | None = None


@dataclass(frozen=True)
class Kind:
    """A kind of mistake.

    Attributes:
        name: Its name.
        side: Who makes it: the author of the plan or of a script.
        meaning: What is done.
        causes: Codes of findings that state this cause.
        sites: Lists the places in a product where it can be made.
        misplaces: Whether the plan orders connectors elsewhere than the scripts build the features. Then a script departs from its order
            as well as the plan from its meaning, so that either may be asked.
    """

    name: str
    side: Side
    meaning: str
    causes: frozenset[str]
    sites: Callable[[Product], Iterable[Site]]
    misplaces: bool = False


@dataclass(frozen=True)
class Fault:
    """A product with one mistake."""

    kind: Kind
    good: Product
    bad: Product
    said: str
    names: frozenset[str]

    @property
    def name(self) -> str:
        """Identifies the case: product and kind."""
        return f"{self.good.name}:{self.kind.name}"

    @property
    def digest(self) -> str:
        """Identifies what is tried: the sha256 of plan and scripts."""
        return digest([self.bad.plan, dict(self.bad.scripts)])


def chosen(kinds: Sequence[Kind], products: Sequence[Product], each: int) -> Iterator[Fault]:
    """Yield at most `each` cases of every kind, each in another product, at sites drawn with a fixed seed.

    A draw depends on its own kind and product alone: with further kinds or products, old cases stay as they are.
    """
    for kind in kinds:
        found: list[Fault] = []
        for product in sorted(products, key=lambda product: _draw(kind.name, product.name).random()):
            sites = list(kind.sites(product)) if len(found) < each else []
            if sites:
                found.append(_made(kind, product, _draw(kind.name, product.name).choice(sites)))
        yield from found


def _draw(*names: str) -> random.Random:
    return random.Random(":".join((str(_SEED), *names)))  # noqa: S311 - not for secrets


def _made(kind: Kind, product: Product, site: Site) -> Fault:
    bad = product
    if site.plan is not None:
        plan = copy.deepcopy(product.plan)
        site.plan(plan)
        bad = replace(bad, plan=plan, scripts=obedient(product, plan))
    if site.script is not None:
        part, written = site.script
        bad = replace(bad, scripts={**product.scripts, part: written()})
    return Fault(kind, product, bad, site.said, site.names)


OBEDIENT: Final = "\n\n_as_before = build\n"  # begins what is added to the script of an author who follows a faulty plan
_OBEDIENT: Final = """_PLACES = {places}


def build(part):
    shape, connectors = _as_before(part)
    connectors = dict(connectors)
    for name, place in _PLACES.items():
        ordered, built = part.connectors[name], connectors[name]
        if isinstance(built, dict):  # else it is the entry of the plan
            moved = tuple(at + new - old for at, new, old in zip(built["o"], ordered.o, place))
            connectors[name] = {{"o": moved, "z": ordered.z, "x": ordered.x}}
    return shape, connectors
"""


def obedient(product: Product, plan: Json) -> Mapping[str, str]:
    """Return the scripts of authors who follow a faulty plan: connectors of another place or direction are moved as the plan moves them.

    Their places still follow the dimensions.
    """
    before = {part["name"]: part for part in product.plan["parts"]}
    scripts = dict(product.scripts)
    for part in plan["parts"]:
        old = {entry["name"]: entry for entry in before.get(part["name"], part).get("connectors", ())}
        changed = [entry["name"] for entry in part.get("connectors", ()) if entry != old.get(entry["name"], entry)]
        name = part["name"]
        if changed and "freecad" not in scripts[name]:
            own = product.resolved.parts[name].connectors
            scripts[name] += OBEDIENT + _OBEDIENT.format(places={one: tuple(own[one].frame.translation.tolist()) for one in changed})
    return scripts
