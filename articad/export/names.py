"""Names that every reader accepts: ROS, MuJoCo and USD all accept a letter followed by letters, digits and underscores."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable

MAX_LENGTH = 120  # characters; files are named after parts, and file systems allow 255 bytes
_DEVICE = re.compile("con|prn|aux|nul|com[0-9]|lpt[0-9]", re.IGNORECASE)  # with any suffix: Microsoft, Naming Files, Paths, and Namespaces


def called(tag: str, names: Iterable[str]) -> str:
    """Return the words for the names that the shapes of a link have.

    Args:
        tag: "visual" or "collision".
        names: Of those that have one, in order.
    """
    return f"names of <{tag}>: {', '.join(names)}"


def valid_name(wanted: str) -> str:
    """Return the name with everything but ASCII letters, digits and underscores replaced."""
    plain = unicodedata.normalize("NFKD", wanted).encode("ascii", "ignore").decode()
    name = re.sub(r"[^A-Za-z0-9_]+", "_", plain)[:MAX_LENGTH]
    if name != wanted:
        name = name.strip("_")
    return name if name[:1].isalpha() else f"n{name}"


class Names:
    """Assigns valid names, each once, and none that is reserved.

    Args:
        reserved: Names that are taken.
        valid: Returns a valid name for any text; `str` where every text is valid.
    """

    def __init__(self, reserved: Iterable[str] = (), *, valid: Callable[[str], str] = valid_name) -> None:
        self._taken: set[str] = set(map(self._key, reserved))
        self._next: dict[str, int] = {}  # name -> the number that it gets next: counting from 2 each time would be quadratic
        self._valid = valid
        self.changed: dict[str, str] = {}

    def claim(self, wanted: str) -> str:
        """Return `wanted` if it is valid and unused, else a similar valid name; `changed` records which."""
        name = free = self._valid(wanted)
        number = self._next.get(name, 2)
        while self._key(free) in self._taken:
            free = f"{name}_{number}"
            number += 1
        self._next[name] = number
        self._taken.add(self._key(free))
        if free != wanted:
            self.changed[wanted] = free
        return free

    @staticmethod
    def _key(name: str) -> str:
        """Return what two names may not have in common."""
        return name


def _valid_file(wanted: str) -> str:
    name = valid_name(wanted)
    return f"{name}_file" if _DEVICE.fullmatch(name) else name


class FileNames(Names):
    """Names of files on every system: two never differ by case alone, and none is that of a device of Windows."""

    def __init__(self, reserved: Iterable[str] = (), *, valid: Callable[[str], str] = _valid_file) -> None:
        super().__init__(reserved, valid=valid)

    @staticmethod
    def _key(name: str) -> str:
        return name.casefold()


def file_name(wanted: str) -> str:
    """Return the beginning of a file's name for a name that anybody may have given: no folders, hidden files, options or devices, at most 60 characters.

    Two names may get the same one; where several files of one kind share a folder, use `file_names`.
    """
    name = re.sub(r"[^A-Za-z0-9_.-]+", "_", wanted).lstrip("._-").rstrip("._")
    first, dot, rest = name.partition(".")
    if _DEVICE.fullmatch(first):
        name = f"{first}_file{dot}{rest}"
    return name[:60].rstrip("._") or "model"


def file_names(wanted: Iterable[str], reserved: Iterable[str] = ()) -> dict[str, str]:
    """Return the beginning of a file's name for each name, as `file_name` does; a number follows where two would be alike or one is reserved.

    Args:
        wanted: All names, those included whose files another run writes: then a name gets the same file in each run.
        reserved: Beginnings that other files of the folder have.
    """
    taken = FileNames(reserved, valid=file_name)
    return {name: taken.claim(name) for name in sorted(dict.fromkeys(wanted), key=lambda name: file_name(name) != name)}
