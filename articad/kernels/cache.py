"""Built parts on disk, by digest: a folder appears complete or not at all, and its hashes are checked when it is used."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from articad.errors import KernelError
from articad.files import user_folder
from articad.processes import scratch

_SEAL = "seal.json"  # sha256 of every other file of the folder
_TEMPORARY = ".building-"
_STALE_SECONDS = 86400.0  # for a folder that some process left half-written


def default_root() -> Path:
    """Return `$ARTICAD_CACHE`, or `~/.cache/articad/parts`."""
    given = os.environ.get("ARTICAD_CACHE")
    if given:
        return Path(given)
    return user_folder("XDG_CACHE_HOME", ".cache") / "articad" / "parts"


class BuildCache:
    """Folders of results by digest; several processes may share one."""

    def __init__(self, *root: Path | None) -> None:
        """Open a cache.

        Args:
            *root: Its folder; nothing for the user's own cache, None for a temporary one that is deleted with this object.
        """
        self._own: tempfile.TemporaryDirectory[str] | None = None
        if root and root[0] is None:
            self._own = scratch.folder("parts")
        given = root[0] if root else default_root()
        self.root = Path(self._own.name) if self._own is not None else Path(given or default_root())

    def get(self, digest: str) -> Path | None:
        """Return the folder of a digest if it exists and its files are unchanged; a damaged one is removed."""
        folder = self.root / digest
        if not folder.is_dir():
            return None
        if _intact(folder):
            return folder
        self._discard(folder)
        return None

    @contextlib.contextmanager
    def writing(self, digest: str | Callable[[], str]) -> Iterator[Path]:
        """Yield a new folder to write to; if the block ends without an error, it becomes the folder of the digest.

        A digest that depends on what is written is given as a function, which is called at the end of the block.

        If another process was first, its folder stays. After an error nothing is left.

        Raises:
            KernelError: If the disk is full or the folder cannot be written.
        """
        try:
            self.root.mkdir(parents=True, exist_ok=True)
            self._sweep()
            folder = Path(tempfile.mkdtemp(prefix=_TEMPORARY, dir=self.root))
        except OSError as error:
            raise self._unwritable(error) from error
        try:
            yield folder
            seal = {path.name: _hash(path) for path in sorted(folder.iterdir())}
            (folder / _SEAL).write_text(json.dumps(seal, sort_keys=True))
            folder.chmod(0o755)
            name = digest if isinstance(digest, str) else digest()
            try:
                folder.rename(self.root / name)
            except OSError:
                if self.get(name) is None:  # the damaged folder that was in the way has been removed
                    folder.rename(self.root / name)
        except OSError as error:
            raise self._unwritable(error) from error
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def _unwritable(self, error: OSError) -> KernelError:
        return KernelError(
            f"Built parts cannot be kept in {self.root}: {error.strerror}. Set ARTICAD_CACHE to a folder that can be written."
        )

    def keep_failed(self, digest: str, files: dict[str, bytes]) -> Path:
        """Keep the files of a failed build for a picture; the latest of each digest."""
        folder = self.root / f"{digest}.failed"
        for name, content in files.items():
            scratch.write(folder / name, content)
        return folder

    def _discard(self, folder: Path) -> None:
        grave = Path(tempfile.mkdtemp(prefix=_TEMPORARY, dir=self.root))
        with contextlib.suppress(OSError):
            folder.rename(grave / "spoiled")
        shutil.rmtree(grave, ignore_errors=True)

    def _sweep(self) -> None:
        for folder in self.root.glob(f"{_TEMPORARY}*"):
            with contextlib.suppress(OSError):
                if time.time() - folder.stat().st_mtime > _STALE_SECONDS:
                    shutil.rmtree(folder, ignore_errors=True)


def _intact(folder: Path) -> bool:
    try:
        seal = json.loads((folder / _SEAL).read_text())
        return bool(seal) and all(_hash(folder / name) == digest for name, digest in seal.items())
    except (OSError, ValueError, AttributeError):
        return False


def _hash(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
