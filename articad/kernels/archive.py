"""Zip files of unknown origin: unpacked within bounds, whatever their headers claim, and written again in one canonical form."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping

_CHUNK = 1 << 20  # bytes unpacked at once
_ENTRY = b"PK\x01\x02"  # first bytes of each entry of the table
_TIME = (2000, 1, 1, 0, 0, 0)  # date of every entry that is written: equal content gives equal bytes


class BadArchiveError(Exception):
    """A file that is not a zip, or that would unpack to more than the limit."""


class Archive:
    """The entries of a zip file, by name.

    Attributes:
        names: In the file's order.
    """

    def __init__(self, content: bytes, *, entries: int, unpacked: int) -> None:
        """Read the table of contents.

        Args:
            content: The bytes of the file.
            entries: Largest number of entries.
            unpacked: Largest total size of what is read from it [bytes].

        Raises:
            BadArchiveError: If it is not a zip, or its headers exceed the limits.
        """
        if content.count(_ENTRY) > entries:  # before a list of them is made
            raise BadArchiveError("it is too large")
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(content))
        except Exception as error:  # noqa: BLE001 - zipfile raises whatever it stumbles over: struct.error, ValueError, IndexError
            raise BadArchiveError(f"it is not a zip file: {error}") from None
        self.names = tuple(entry.filename for entry in self._zip.infolist())
        if len(self.names) > entries or sum(entry.file_size for entry in self._zip.infolist()) > unpacked:
            raise BadArchiveError("it is too large")
        if len(set(self.names)) != len(self.names):
            raise BadArchiveError("it holds two entries of the same name")
        self._left = unpacked

    def read(self, name: str, most: int | None = None) -> bytes:
        """Return the content of an entry, unpacked piece by piece: a zip bomb is noticed before it fills memory.

        Args:
            name: Name of the entry.
            most: Largest size of the entry [bytes]; by default what is left of the limit.

        Raises:
            BadArchiveError: If there is no entry of this name, it is damaged, or the limit is exceeded.
        """
        content, left = bytearray(), self._left if most is None else min(most, self._left)
        try:
            with self._zip.open(name) as stream:
                while len(content) <= left and (piece := stream.read(_CHUNK)):
                    content += piece
        except Exception as error:  # noqa: BLE001 - as above, and zlib.error, EOFError, NotImplementedError
            raise BadArchiveError(f"{name} cannot be unpacked: {error}") from None
        self._left -= len(content)
        if len(content) > left:
            raise BadArchiveError(f"{name} is too large")
        return bytes(content)


def packed(entries: Mapping[str, bytes]) -> bytes:
    """Return a zip file of these entries, in this order.

    Programs that read a zip from its front and those that read its table at the end find the same entries in it, which need not be so
    for a file of unknown origin.
    """
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in entries.items():
            entry = zipfile.ZipInfo(name, _TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return stream.getvalue()
