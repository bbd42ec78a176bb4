"""Cheats that leave out a feature: a cut, or a body, that a part's script of the reference makes and that of the cheat does not.

A script that several parts share is changed for all of them. Whoever leaves out what the text names is to be refused. What the text leaves open is named in the task's `left_open`, with the reason.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final

from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.kernels.kernel import BuildCache, PartKernel
from articad_bench.reference import reference, reference_scripts
from articad_bench.script_faults import edited, left_out, makes_shape
from articad_bench.staged_cheats import StagedCheat
from articad_bench.task import Task

__all__ = ["FEATURELESS", "feature_cheats", "features"]

FEATURELESS: Final = "featureless"
SLIGHT: Final = 0.002  # share of a part's volume: nobody sees that less is missing


def feature_cheats(
    folder: Path, task: Task, right: Assembly, before: Assembly | None, cache: BuildCache | None = None, kernel: PartKernel | None = None
) -> Iterator[StagedCheat]:
    """Yield the reference without each feature that its own scripts make and the task does not leave open.

    Args:
        folder: Of the task.
        task: The task.
        right: Its reference.
        before: The product that it begins with, if it does.
        cache: Keeps built parts.
        kernel: Builds the scripts.
    """
    parts = reference_scripts(folder, task)
    for source in dict.fromkeys(parts.values()):
        of = [part for part, script in parts.items() if script == source]
        for feature, without in features(source).items():
            what = f"{of[0]}: {feature}"
            if what not in task.left_open:
                make = partial(_without, folder, task, right, of, without, cache, kernel)
                yield StagedCheat(FEATURELESS, what, 0, before, right, make)


def features(source: str) -> Mapping[str, Callable[[], str]]:
    """Return what a script cuts out and what it adds, numbered as they are written, and what writes the script without it."""
    return {
        f"{name} {number}": make
        for name, operation in (("cut", ast.Sub), ("body", ast.Add))
        for number, make in enumerate(edited(source, partial(left_out, partial(_operand, operation))), start=1)
    }


def _operand(operation: type[ast.operator], node: ast.AST) -> ast.expr | None:
    """Return what a statement `a -= b` or an expression `a - b` takes away, or adds, if it is a shape."""
    if isinstance(node, ast.AugAssign) and isinstance(node.op, operation):
        return node.value
    if isinstance(node, ast.BinOp) and isinstance(node.op, operation) and makes_shape(node.right):
        return node.right
    return None


def _without(
    folder: Path,
    task: Task,
    right: Assembly,
    parts: Sequence[str],
    without: Callable[[], str],
    cache: BuildCache | None,
    kernel: PartKernel | None,
) -> Assembly | None:
    """Return the reference without a feature; None if it does not build so, or if as good as nothing is missing."""
    try:
        made = reference(folder, task, scripts=dict.fromkeys(parts, without()), cache=cache, kernel=kernel)
    except ArticadError:
        return None
    volumes = [{name: abs(each.mesh.volume) for name, each in product.parts.items() if each.mesh is not None} for product in (right, made)]
    kept = all(abs(volumes[1].get(name, 0.0) - volume) <= SLIGHT * volume for name, volume in volumes[0].items())
    return None if kept else made
