"""The parts of two products are compared whatever their order, and whatever digits a file keeps."""

from __future__ import annotations

from articad.geometry import box
from articad_bench.shape_checks import same_parts
from articad_bench.subject import Subject
from tests.bench.test_function_checks import fixed, of, placed


def pair(move: float) -> Subject:
    """Two parts whose boxes begin at one place along x, midway between two hundredths of a millimetre, or a little to either side of it."""
    long, short = placed(box(10, 10, 10), 5.005 + move, 0, 0), placed(box(10, 10, 5), 5.005 - move, 20, 0)
    return Subject(of(("long", long), ("short", short), joints=[fixed("long", "short")]))


def test_digits_that_a_file_leaves_out_do_not_exchange_parts() -> None:
    assert same_parts(pair(-1e-6), pair(1e-6), 1e-3)
    assert not same_parts(pair(0.0), pair(0.5), 1e-3)
