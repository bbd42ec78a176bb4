"""Names for parts and joints of FreeCAD documents that have one label several times."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from articad.importers.freecad import _free

LABELS = st.lists(st.sampled_from(["a", "a_2", "a_2_2", "a_3", "b"]), max_size=30)


@given(LABELS)
def test_counting_on_gives_the_names_that_counting_from_the_start_gives(labels: list[str]) -> None:
    taken: set[str] = set()
    numbers: dict[str, int] = {}
    for label in labels:
        name = _free(label, taken, numbers)
        assert name == _free(label, taken)
        taken.add(name)
    assert len(taken) == len(labels)


def test_each_label_is_counted_once_however_often_it_comes() -> None:
    looked: list[str] = []

    class Taken(set[str]):
        def __contains__(self, name: object) -> bool:
            looked.append(str(name))
            return super().__contains__(name)

    taken, numbers, count = Taken(), dict[str, int](), 500
    for _ in range(count):
        taken.add(_free("same", taken, numbers))
    assert len(looked) < 3 * count
