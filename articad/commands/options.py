"""Arguments that several commands share, and the functions that parse their values."""

from __future__ import annotations

import argparse
from typing import Final

from articad.commands.command import argument, closest

# The names of `articad.formats.FORMATS`, which --help must not load.
FORMATS: Final = ("urdf", "mjcf", "freecad", "step", "glb", "3mf", "sdf", "usd", "plan")
USUAL: Final = ("urdf", "mjcf")
_SMALLEST_PICTURE, _LARGEST_PICTURE = 16, 8192  # pixels of a side


def formats(text: str) -> tuple[str, ...]:
    """Read `urdf,mjcf`."""
    names = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    for name in names:
        if name not in FORMATS:
            raise argparse.ArgumentTypeError(f"unknown format {name!r}{closest(name, FORMATS)}; there are {', '.join(FORMATS)}")
    return names


def words(text: str) -> str:
    """Read a text that goes to a model or into a record."""
    if any("\ud800" <= character <= "\udfff" for character in text):  # stand for bytes that are not UTF-8
        raise argparse.ArgumentTypeError("the text is not UTF-8")
    return text


def assignment(text: str) -> tuple[str, str]:
    """Read `NAME=VALUE`."""
    name, sign, value = text.partition("=")
    if not (sign and name and value):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form NAME=VALUE")
    return name, value


def parameter(text: str) -> tuple[str, float]:
    """Read `NAME=NUMBER`."""
    name, value = assignment(text)
    try:
        return name, float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{value!r} in {text!r} is not a number") from None


def names(text: str) -> tuple[str, ...]:
    """Read `a,b`."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def amount(text: str) -> float:
    """Read a positive number."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return number


def positive(text: str) -> int:
    """Read a whole number of at least 1."""
    if not (text.isdecimal() and int(text) >= 1):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of at least 1")
    return int(text)


def extent(text: str) -> tuple[int, int]:
    """Read `512` or `1280x720`: a width and a height of at least 16."""
    sides = text.lower().split("x")
    found = (int(sides[0]), int(sides[-1])) if len(sides) <= len("wh") and all(map(str.isdecimal, sides)) else (0, 0)
    if not all(_SMALLEST_PICTURE <= side <= _LARGEST_PICTURE for side in found):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a size such as 512 or 1280x720, each side from {_SMALLEST_PICTURE} to {_LARGEST_PICTURE} pixels"
        )
    return found


OUT = argument("--out", metavar="DIR", help="where to write; by default a new folder under runs/")
SANDBOX = argument(
    "--sandbox", choices=["strict", "weak"], default=None, help="weak runs part scripts with less isolation than landlock or bwrap"
)
JOBS = argument("--jobs", metavar="N", type=positive, default=None, help="parts built at once (all processors)")
FORCE = argument("--force", action="store_true", help="rebuild every part, whatever the cache holds")
EXPORT = argument("--export", metavar="FORMATS", dest="formats", type=formats, default=USUAL, help="formats to write (urdf,mjcf)")
PICTURES = argument("--no-pictures", dest="pictures", action="store_false", help="draw neither parts nor motion, and write no page")
SET = argument("--set", metavar="NAME=VALUE", dest="parameters", type=parameter, action="append", default=[], help="replace a parameter")
SPLIT = argument("--split", action="store_true", help="for FreeCAD: write one file for each part, and an assembly that links to them")
TREES = argument(
    "--trees",
    action="store_true",
    help="for FreeCAD: trace build123d scripts, so that their parts get feature trees that follow the parameters (slower the first time)",
)
DRAWINGS = argument(
    "--drawings", action="store_true", help="for FreeCAD: add a dimensioned page for each part, one of the assembly, and an exploded view"
)
BUILD_ARGUMENTS = (
    OUT,
    argument("--kernel", choices=["build123d", "freecad"], default=None, help="the kernel that builds part scripts (the plan's choice)"),
    SET,
    argument("--verify", choices=["rest", "sampled", "certified"], default="rest", help="how much motion is checked (rest)"),
    EXPORT,
    SANDBOX,
    JOBS,
    FORCE,
    PICTURES,
)
ENGINE = (
    argument("--engine", choices=["local", "dask"], default="local", help="processes of this machine, or a Dask cluster (local)"),
    argument("--scheduler", metavar="URL", help="address of the Dask scheduler; its workers must see the folders"),
)
MEMORY = argument("--memory", metavar="DIR", help="the store of earlier runs ($ARTICAD_MEMORY, or the user's own)")
EMBEDDINGS = argument(
    "--embeddings", metavar="NAME", help="a provider's embedding model that measures the similarity of cases (offline word vectors)"
)
API_BASE = argument("--api-base", metavar="URL", help="an OpenAI-compatible endpoint")
MODELS = (
    argument(
        "--model", metavar="NAME", default=None, help="the model, by LiteLLM's name ($ARTICAD_MODEL, else gemini/gemini-3-flash-preview)"
    ),
    argument("--vision-model", metavar="NAME", help="the model that gets pictures (the same)"),
    argument("--judge-model", metavar="NAME", help="the model that judges the assembly (the same)"),
    API_BASE,
)
TEACHING = (
    MEMORY,
    EMBEDDINGS,
    argument("--docs", action="store_true", help="let the model look up names in the kernel's documentation"),
)
BUDGET = (
    argument("--max-calls", metavar="N", type=positive, default=60, help="model calls (bench: per task) (60)"),
    argument("--max-tokens", metavar="N", type=positive, default=None, help="tokens of these calls (unlimited)"),
    argument("--max-cost", metavar="USD", type=amount, default=None, help="cost of these calls (unlimited)"),
    argument("--max-minutes", metavar="N", type=amount, default=60.0, help="wall-clock minutes (bench: per task) (60)"),
)
ASKING = (
    *MODELS,
    argument(
        "--look",
        action="store_true",
        default="together",
        help="compare pictures of each part with its specification in a request of its own (by default up to six parts in one request)",
    ),
    argument("--no-look", dest="look", action="store_false", default="together", help="compare no pictures of parts"),
    argument("--no-inspection", dest="inspection", action="store_false", help="do not let models observe and judge the assembly"),
    *TEACHING,
    argument("--rounds", metavar="N", type=positive, default=3, help="number of designs that are built and checked (3)"),
    argument("--repairs", metavar="N", type=positive, default=3, help="attempts to repair one part (3)"),
    *BUDGET,
)
ANSWERING = (
    argument("--image", metavar="FILE", dest="images", action="append", default=[], help="a picture for the request"),
    argument("--review", action="store_true", help="score the finished assembly, by rules and by a model that looks at all of it"),
    *ASKING,
)
GENERATING = (
    argument(
        "--part-image", metavar="NAME=FILE", dest="part_images", type=assignment, action="append", default=[], help="a picture for one part"
    ),
    argument(
        "--kernel", choices=["build123d", "freecad"], default="build123d", help="the kernel for which part scripts are written (build123d)"
    ),
    argument("--ideas", choices=["auto", "always", "never"], default="auto", help="propose alternatives first (auto: for open requests)"),
    argument("--pick", metavar="N", type=positive, default=None, help="propose alternatives and make the N-th, without asking"),
    argument(
        "--variant",
        choices=["full", "late", "no-rollback", "no-memory", "single-loop"],
        default="full",
        help="the full pipeline, or one of the paper's ablations or its baseline (full)",
    ),
)
